"""What all tests of the campaign share: programs, sizes, a scratch folder, the table."""

import random
import shutil
import subprocess
import threading
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from content import same_run
from program import Lost, Program


@dataclass
class Sizes:
    """How much of each test is run; None for all there is."""

    kills: int | None = None
    errors: int | None = None
    results: int | None = None
    disks: int | None = None
    rounds: int = 40
    clocks: int = 5
    moments: int = 1000
    ranks: int = 100
    generations: int = 1_000_000
    soak: int = 7200


QUICK = Sizes(
    kills=16,
    errors=20,
    results=4,
    disks=4,
    rounds=2,
    clocks=1,
    moments=40,
    ranks=4,
    generations=60_000,
    soak=6,
)


class Campaign:
    """The tests' common ground."""

    def __init__(self, farsa, clock, folder, table, sizes, jobs=1, seed=1):
        self.farsa = Program(farsa, clock)
        self.folder = Path(folder)
        self.table = table
        self.sizes = sizes
        self.jobs = jobs
        self.random = random.Random(seed)
        self.failing = None
        self.ranks = None
        self.references = {}
        self.making = threading.Lock()

    def choose(self, cases, count):
        """So many of the cases, drawn without replacement, or all."""
        if count is None or count >= len(cases):
            return cases
        chosen = set(self.random.sample(range(len(cases)), count))
        return [case for number, case in enumerate(cases) if number in chosen]

    def scratch(self, *parts):
        """A folder of that name, empty."""
        folder = self.folder.joinpath(*(part.replace(" ", "-") for part in parts))
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        return folder

    def reference(self, experiment):
        """A folder with `r` in it, the run that nothing happened to."""
        key = f"{experiment.name} {experiment.generations}"
        with self.making:
            if key not in self.references:
                here = self.scratch("references", key)
                self.farsa.succeed(here, experiment.begin(), clock="slow")
                # The reference itself is compared with one of the true clock and of two threads.
                other = self.scratch("references", f"{key} again")
                again = self.farsa.succeed(other, experiment.begin(threads=2))
                same_run(other, here, again)
                shutil.rmtree(other)
                self.references[key] = here
            return self.references[key]

    def attempt(self, test, label, try_it):
        """Tries one case in a folder of its own, which is kept if something is lost."""
        here = self.scratch(test, label)
        try:
            try_it(here)
        except Lost as lost:
            self.table.lost(test, f"{label}: {lost}", lost.command, here)
        except (OSError, subprocess.SubprocessError, ValueError) as error:
            self.table.lost(test, f"{label}: {error!r}", "", here)
        else:
            self.table.survived(test)
            shutil.rmtree(here, ignore_errors=True)

    def attempts(self, test, cases):
        """Tries cases, pairs of a label and a function of a folder, several at a time."""
        self.table.begin(test)
        with ThreadPoolExecutor(self.jobs) as pool:
            list(pool.map(lambda case: self.attempt(test, *case), cases))
        self.table.say(self.table.line(test))
