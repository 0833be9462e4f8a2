"""A program that is run with injected faults and wrong clocks, and what it said."""

import os
import shlex
import signal
import subprocess
from dataclasses import dataclass
from pathlib import Path

# Seconds after which a program hangs.
PATIENCE = 120


class Lost(Exception):
    """What should have held and did not."""

    def __init__(self, why, result=None):
        super().__init__(why)
        self.command = result.command if result else ""


@dataclass
class Result:
    """How a command ended: its exit code, or minus a signal."""

    code: int
    out: str
    err: str
    command: str

    def said(self):
        """The end of what it said, in one line."""
        return " ".join(self.err.split())[-300:]

    def check(self, codes=(0, 1, 2), silent=False):
        """Loses a command that panicked, died, or failed without a word."""
        if self.code not in codes:
            raise Lost(f"ended with {self.code}: {self.said()}", self)
        if "panicked" in self.err:
            raise Lost(f"panicked: {self.said()}", self)
        if self.code != 0 and not silent and "error:" not in self.err:
            raise Lost(f"failed without a word: {self.said()}", self)
        return self


def compile_clock(folder):
    """Compiles clock.c, and returns where the library is."""
    library = Path(folder) / "clock.so"
    source = Path(__file__).with_name("clock.c")
    subprocess.run(["cc", "-shared", "-fPIC", "-O1", "-o", library, source], check=True)
    return library


class Program:
    """The `farsa` command, or one like it."""

    def __init__(self, words, clock):
        self.words = [str(word) for word in words]
        self.clock = clock

    def command(self, arguments, inject=None, clock=None, trace=None):
        """The words of a command line: inject is a system call and its fault, as strace has it."""
        words = [*self.words, *arguments]
        variables = []
        if clock:
            variables = [f"LD_PRELOAD={self.clock}", f"CAMPAIGN_CLOCK={clock}"]
        if inject or trace:
            of = inject.split(":")[0] if inject else trace[0]
            start = ["strace", "-f", "-o", trace[1] if trace else os.devnull, "-e", f"trace={of}"]
            if inject:
                start += ["-e", f"inject={inject}"]
            return start + [word for v in variables for word in ("-E", v)] + words
        return ["env", *variables, *words] if variables else words

    def start(self, here, arguments, **options):
        """Starts a command in a folder, in a process group of its own."""
        words = [str(word) for word in self.command(arguments, **options)]
        process = subprocess.Popen(
            words,
            cwd=here,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            start_new_session=True,
            # A shell's background ignores SIGINT, and children inherit that.
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
            errors="replace",
            text=True,
        )
        process.line = f"cd {shlex.quote(str(here))} && {shlex.join(words)}"
        return process

    def end(self, process, patience=PATIENCE):
        """Waits for its end."""
        try:
            out, err = process.communicate(timeout=patience)
        except subprocess.TimeoutExpired:
            kill(process)
            out, err = process.communicate()
            result = Result(0, out, err, process.line)
            raise Lost(f"hangs: it was killed after {patience} s", result) from None
        return Result(process.returncode, out, err, process.line)

    def run(self, here, arguments, patience=PATIENCE, **options):
        """Runs a command to its end."""
        return self.end(self.start(here, arguments, **options), patience)

    def succeed(self, here, arguments, **options):
        """Runs a command that must succeed."""
        return self.run(here, arguments, **options).check(codes=(0,))


def kill(process):
    """Kills a process and all that it has started."""
    try:
        os.killpg(process.pid, signal.SIGKILL)
    except ProcessLookupError:
        pass
