"""Runs of the command as numpy arrays and dictionaries."""

from __future__ import annotations

import csv
import html
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from os import PathLike, fspath
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._farsa_gym import Run as _Run


def command(words: Sequence[str | PathLike[str]], *, check: bool = True) -> str:
    """Runs the command `farsa` in a separate process and returns its output.

    With `check`, an exit code other than 0 raises a `RuntimeError` with the code and the message.
    """
    line = [sys.executable, "-m", "farsa_gym", *map(fspath, words)]
    done = subprocess.run(line, stdin=subprocess.DEVNULL, capture_output=True, text=True, encoding="utf-8")
    if check and done.returncode != 0:
        raise RuntimeError(f"farsa ended with the exit code {done.returncode}: {done.stderr.strip()}")
    return done.stdout


class Run:
    """The directory of a run, which is only read."""

    def __init__(self, path: str | PathLike[str]) -> None:
        self.path = Path(path)
        self._run = _Run(self.path)
        about = self._run.about()
        self.experiment: str = about["experiment"]
        self.condition: str = about["condition"]
        self.strategy: str = about["strategy"]
        self.seed: int = about["seed"]
        self.settings: dict[str, Any] = about["settings"]

    @property
    def config(self) -> str:
        """The complete configuration as TOML."""
        return self._run.config()

    def curves(self) -> dict[str, NDArray[np.float64]]:
        """Returns best, mean and worst fitness, evaluations and failures of each generation."""
        columns = self._run.curves().T
        return dict(zip(("best", "mean", "worst", "evaluations", "failed"), columns, strict=True))

    def champion(self) -> dict[str, Any]:
        """Returns generation, individuals, fitness and parameters of the champion of each population."""
        return dict(zip(("generation", "individuals", "fitness", "parameters"), self._run.champion(), strict=True))

    def parameters(self, generation: int) -> NDArray[np.float32]:
        """Returns the parameters of all individuals of a generation."""
        return self._run.parameters(generation)

    def tests(self) -> dict[str, NDArray[Any]]:
        """Returns trial, steps, success and fitness of each trial of the last `farsa test`."""
        rows = self._run.tests()
        return {name: np.array([row[k] for row in rows]) for k, name in enumerate(("trial", "steps", "success", "fitness"))}

    def trial(self, number: int = 0) -> dict[str, NDArray[np.float64]]:
        """Repeats a trial of the champion and returns a column for each sensor, neuron, output and term."""
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder, "trial.csv")
            command(["replay", self.path, "--trial", str(number), "--out", file, "--quiet"])
            with open(file, newline="", encoding="utf-8") as text:
                names, *rows = csv.reader(text)
        columns = np.array([[float(value) for value in row] for row in rows])
        return dict(zip(names, columns.T, strict=True))

    def page(self, number: int = 0) -> str:
        """Repeats a trial of the champion and returns its interactive page."""
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder, "trial.html")
            command(["replay", self.path, "--trial", str(number), "--html", file, "--quiet"])
            return file.read_text(encoding="utf-8")

    def _repr_html_(self) -> str:
        page = html.escape(self.page(), quote=True)
        return f'<iframe srcdoc="{page}" width="100%" height="600" style="border:0"></iframe>'

    def __repr__(self) -> str:
        return f"Run({str(self.path)!r}: {self.experiment}, {self.strategy}, seed {self.seed})"


def load_run(path: str | PathLike[str]) -> Run:
    """Opens the directory of a run."""
    return Run(path)
