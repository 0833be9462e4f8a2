"""What a machine that loses its power may leave: nothing is renamed before it is on the disk."""

import os
import re

from content import copy
from program import Lost

CALLS = "openat,write,ftruncate,fsync,fdatasync,rename,renameat,renameat2,close"
LINE = re.compile(r"^(\d+) +(.*)$")
RESUMED = re.compile(r"^<\.\.\. \w+ resumed>(.*)$")
CALL = re.compile(r"^(\w+)\((.*)\) += (-?\d+)")
PATH = re.compile(r'"([^"]*)"')


def whole_lines(text):
    """The calls of a trace, those that strace tells in two parts brought together."""
    begun = {}
    for line in text.splitlines():
        match = LINE.match(line)
        if not match:
            continue
        thread, said = match.groups()
        if said.endswith("<unfinished ...>"):
            begun[thread] = said.removesuffix("<unfinished ...>")
            continue
        resumed = RESUMED.match(said)
        yield begun.pop(thread, "") + resumed.group(1) if resumed else said


class Disk:
    """What is on the disk for certain, call by call."""

    def __init__(self, here):
        self.here = str(here)
        self.open, self.unsynced, self.renamed = {}, set(), {}
        self.renames = 0

    def path(self, words):
        """The absolute path of the first name in the arguments."""
        return os.path.normpath(os.path.join(self.here, PATH.search(words).group(1)))

    def call(self, name, words, status):
        """Takes note of a call that succeeded."""
        if name == "openat":
            self.open[status] = self.path(words)
        elif name in ("write", "ftruncate", "fsync", "fdatasync", "close"):
            path = self.open.get(int(re.match(r"\d+", words).group()))
            if name in ("write", "ftruncate") and path:
                self.unsynced.add(path)
            elif name == "close":
                self.open.pop(int(re.match(r"\d+", words).group()), None)
            elif path:
                self.unsynced.discard(path)
                self.renamed.pop(path, None)
        elif name.startswith("rename"):
            self.rename(*(os.path.join(self.here, path) for path in PATH.findall(words)))

    def rename(self, old, new):
        """Loses what is renamed too early."""
        old, new = os.path.normpath(old), os.path.normpath(new)
        self.renames += 1
        if self.renamed:
            raise Lost(f"{new} is renamed, {self.renamed} perhaps not yet")
        of_run = {path for path in self.unsynced if path.startswith(os.path.dirname(new))}
        early = of_run if new.endswith("checkpoint.bin") else of_run & {old}
        if early:
            raise Lost(f"{new} is renamed, {sorted(early)} perhaps not yet written")
        self.renamed[os.path.dirname(new)] = new
        for number, path in self.open.items():
            if path == old or path.startswith(old + "/"):
                self.open[number] = new + path[len(old) :]


def ordered(campaign, experiment, after):
    """A function of a folder that looks at the calls of a run in their order."""
    half = campaign.reference(experiment.of(max(1, experiment.generations // 2)))

    def try_it(here):
        if after:
            copy(half / "r", here / "r")
        arguments = experiment.resume() if after else experiment.begin()
        trace = here / "trace"
        result = campaign.farsa.run(here, arguments, trace=(CALLS, trace), clock="slow")
        disk = Disk(here)
        try:
            for line in whole_lines(trace.read_text(errors="replace")):
                match = CALL.match(line)
                if match and int(match.group(3)) >= 0:
                    disk.call(match.group(1), match.group(2), int(match.group(3)))
            if disk.renamed or disk.renames < 3:
                raise Lost(f"at the end {disk.renamed} is perhaps not on the disk")
        except Lost as lost:
            lost.command = result.command
            raise

    return try_it


def run(campaign, experiments):
    """All of them."""
    cases = [
        (f"{experiment.name} {phase}", ordered(campaign, experiment, phase == "resume"))
        for experiment in experiments
        for phase in ("begin", "resume")
    ]
    campaign.attempts("order of synchronisation", cases)
