"""The experiments whose runs are attacked: short ones, of each kind."""

import copy
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


class Experiment:
    """A run of a few generations, and whoever reads it."""

    def __init__(self, name, arguments, generations=4, export=()):
        self.name = name
        self.arguments = [str(word) for word in arguments]
        self.generations = generations
        # What `export` needs to know; None where there is nothing to export.
        self.export = None
        if export is not None:
            words = ["--format", "json", "--out", "c.json"]
            self.export = ["export", "controller", "r", *export, *words]

    def of(self, generations):
        """The same with another number of generations."""
        other = copy.copy(self)
        other.generations = generations
        return other

    def begin(self, out="r", threads=1):
        """The words that begin a run."""
        count = ["--generations", str(self.generations), "--threads", str(threads)]
        return ["run", *self.arguments, *count, "--out", out, "-q"]

    def resume(self, out="r", threads=1):
        """The words that go on with it."""
        count = ["--generations", str(self.generations), "--threads", str(threads)]
        return ["run", "--resume", out, *count, "-q"]

    def readers(self):
        """Commands that read a run, with the file that each writes."""
        readers = [
            (["report", "r", "--html", "page.html", "-q"], "page.html"),
            (["test", "r", "--trials", "1", "--threads", "1", "-q"], "r/test.csv"),
            (["replay", "r", "--trial", "0", "--out", "trial.csv", "-q"], "trial.csv"),
        ]
        return readers + ([(self.export, "c.json")] if self.export else [])


def settings(*pairs):
    """Settings as words of a command line."""
    return [word for pair in pairs for word in ("--set", pair)]


ONE = Experiment(
    "one population", ["discrimination", *settings("trial.count=2", "trial.steps=20")]
)
SEVERAL = Experiment(
    "several populations",
    [
        *("predator-prey", "--population", "4"),
        *settings("evolution.parents=2", "trial.steps=20", "trial.count=2"),
    ],
    generations=3,
    export=["--population", "prey"],
)
FILES = Experiment(
    "experiment of several files",
    [
        *(ROOT / "experiments" / "reaching.toml", "--population", "6"),
        *settings("episode.trials=1", "episode.steps=20"),
    ],
    generations=3,
)
COLLECTION = Experiment(
    "growing collection",
    [
        *("discrimination", "--strategy", "map-elites", "--population", "24"),
        *settings("trial.count=2", "trial.steps=20"),
    ],
    generations=3,
)
# Of the example `faulty`: with a table of failures.
FAILING = Experiment(
    "failing trials",
    [
        *("faulty", "--population", "10"),
        *settings("fault.rate=0.1", "trial.steps=20"),
    ],
    generations=3,
    export=None,
)
EXPERIMENTS = [ONE, SEVERAL, FILES, COLLECTION]
