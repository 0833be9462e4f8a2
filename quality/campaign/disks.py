"""File systems that are really full, have no inodes left, or are read-only: tmpfs of root."""

import os
import subprocess
from contextlib import contextmanager

from aftermath import read
from content import copy, nothing_but, same_run
from program import Lost

FULL = [f"size={size}k" for size in (4, 8, 12, 16, 20, 24, 28, 32, 40, 48)]
BARE = [f"nr_inodes={count}" for count in range(2, 14)]


def mount(*words):
    """Whether mounting succeeded."""
    return subprocess.run(["mount", *words], capture_output=True).returncode == 0


@contextmanager
def file_system(options, folder):
    """A tmpfs at a folder, as long as it is needed."""
    folder.mkdir(exist_ok=True)
    if not mount("-t", "tmpfs", "-o", options, "tmpfs", str(folder)):
        raise Lost(f"tmpfs with {options} cannot be mounted")
    try:
        yield
    finally:
        subprocess.run(["umount", "-l", folder], check=True)


def possible(campaign):
    """Whether this process may mount."""
    if os.geteuid() != 0:
        return False
    folder = campaign.scratch("mounts")
    if not mount("-t", "tmpfs", "-o", "size=4k", "tmpfs", str(folder)):
        return False
    subprocess.run(["umount", folder], check=True)
    return True


def more_than(run, options):
    """Options that leave so much beside a run."""
    kind, number = options.rstrip("k").split("=")
    files = list(run.iterdir())
    if kind == "size":
        used = sum(path.stat().st_blocks // 2 for path in files)
        return f"size={used + int(number)}k"
    return f"nr_inodes={len(files) + int(number)}"


def full(campaign, experiment, options, after):
    """A function of a folder that runs on such a file system, then on one with room."""
    reference, farsa = campaign.reference(experiment), campaign.farsa
    half = campaign.reference(experiment.of(max(1, experiment.generations // 2)))

    def try_it(here):
        room = here / "room"
        with file_system(options if not after else "size=4m", room):
            if after:
                copy(half / "r", room / "r")
                tight = more_than(room / "r", options)
                if not mount("-o", f"remount,{tight}", str(room)):
                    raise Lost(f"{tight} cannot be set")
            arguments = experiment.resume() if after else experiment.begin()
            first = farsa.run(room, arguments, clock="slow").check()
            if not mount("-o", "remount,size=4m,nr_inodes=1000", str(room)):
                raise Lost("room cannot be made")
            read(farsa, room, experiment)
            begun = (room / "r").exists()
            arguments = experiment.resume() if begun else experiment.begin()
            last = farsa.succeed(room, arguments)
            last.command = f"on a tmpfs with {options}: {first.command}\n  then:    {last.command}"
            nothing_but(room, ["r"], last)
            same_run(room / "r", reference / "r", last)

    return try_it


def read_only(campaign, experiment):
    """A function of a folder that uses a run on a read-only file system."""
    farsa, reference = campaign.farsa, campaign.reference(experiment)

    def try_it(here):
        room = here / "room"
        with file_system("size=4m", room):
            copy(reference / "r", room / "r")
            if not mount("-o", "remount,ro", str(room)):
                raise Lost("cannot be made read-only")
            run = "room/r"
            more = experiment.of(experiment.generations + 1)
            writers = [
                more.resume(out=run),
                experiment.begin(out="room/other"),
                ["test", run, "--trials", "1", "--threads", "1", "-q"],
                ["report", run, "--html", "room/page.html", "-q"],
            ]
            for arguments in writers:
                result = farsa.run(here, arguments).check()
                if result.code == 0 or "ead-only" not in result.err:
                    raise Lost(f"did not say that it cannot write: {result.said()}", result)
            readers = [
                ["report", run, "--html", "page.html", "-q"],
                ["replay", run, "--trial", "0", "--out", "trial.csv", "-q"],
                [word.replace("r", run) if word == "r" else word for word in experiment.export],
            ]
            for arguments in readers:
                last = farsa.succeed(here, arguments)
            nothing_but(room, ["r"], last)
            same_run(room / "r", reference / "r", last)

    return try_it


def run(campaign, experiments):
    """All of them."""
    if not possible(campaign):
        for test in ("full file systems", "no inodes left", "read-only file system"):
            campaign.table.not_run(test, "needs root")
        return
    for test, kinds in (("full file systems", FULL), ("no inodes left", BARE)):
        cases = [
            (
                f"{experiment.name} {options} {'resume' if after else 'begin'}",
                full(campaign, experiment, options, after),
            )
            for experiment in experiments
            for options in kinds
            for after in (False, True)
        ]
        campaign.attempts(test, campaign.choose(cases, campaign.sizes.disks))
    cases = [(experiment.name, read_only(campaign, experiment)) for experiment in experiments]
    campaign.attempts("read-only file system", cases)
