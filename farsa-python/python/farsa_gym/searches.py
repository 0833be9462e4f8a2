"""Evaluation of parameters, and strategies by ask and tell."""

from __future__ import annotations

from collections.abc import Mapping
from os import PathLike, fspath
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._farsa_gym import Problem, Search


def _matrix(values: ArrayLike, dtype: type[np.floating[Any]], what: str) -> NDArray[Any]:
    array = np.asarray(values)
    if array.dtype.kind not in "fiu":
        raise TypeError(f"{what} have the dtype {array.dtype}, not a real number such as {np.dtype(dtype)}")
    if array.ndim != 2:
        raise ValueError(f"{what} have the shape {array.shape}, not (individuals, numbers)")
    return np.ascontiguousarray(array, dtype=dtype)


def describe(
    experiment: str | PathLike[str],
    *,
    condition: str | None = None,
    settings: Mapping[str, Any] | None = None,
) -> dict[str, Any]:
    """Describes an experiment: its parameters with ranges, sensors, motors, trials, terms and settings."""
    return Problem(fspath(experiment), condition, None if settings is None else dict(settings)).about()


class Evaluator:
    """An experiment that evaluates generations on all threads. Results do not depend on threads and lanes."""

    def __init__(
        self,
        experiment: str | PathLike[str],
        *,
        condition: str | None = None,
        settings: Mapping[str, Any] | None = None,
        threads: int = 0,
        lanes: int | None = None,
    ) -> None:
        values = None if settings is None else dict(settings)
        self._problem = Problem(fspath(experiment), condition, values, None, 1, threads, lanes)
        self.about = self._problem.about()

    def decode(self, genes: ArrayLike) -> NDArray[np.float32]:
        """Decodes real genes into parameters. -1 and 1 are the ends of each range."""
        return self._problem.decode(_matrix(genes, np.float64, "genes"))

    def __call__(
        self, parameters: ArrayLike, *, seed: int = 1, generation: int = 0, individual: int = 0
    ) -> tuple[NDArray[np.float64], list[dict[str, Any]]]:
        """Returns the fitness of each row of parameters, NaN after a failure, and notes."""
        matrix = _matrix(parameters, np.float32, "parameters")
        fitness, individuals = self._problem.evaluate(matrix, seed, generation, individual)
        return fitness, [self._note(*row) for row in individuals]

    def _note(self, scores: list[float], failure: str | None, trials: list[Any]) -> dict[str, Any]:
        names = self.about["terms"]
        listed = [
            {"terms": dict(zip(names, terms, strict=True)), "steps": steps, "success": success, "notes": notes}
            for terms, steps, success, notes in trials
        ]
        return {"fitness": scores[0] if scores else None, "scores": scores, "failed": failure, "trials": listed}


def evaluate(
    experiment: str | PathLike[str],
    parameters: ArrayLike,
    *,
    seed: int = 1,
    generation: int = 0,
    individual: int = 0,
    condition: str | None = None,
    settings: Mapping[str, Any] | None = None,
    threads: int = 0,
    lanes: int | None = None,
) -> tuple[NDArray[np.float64], list[dict[str, Any]]]:
    """Evaluates rows of parameters as `farsa evaluate --stdin` does. Use an `Evaluator` for several generations."""
    evaluator = Evaluator(experiment, condition=condition, settings=settings, threads=threads, lanes=lanes)
    return evaluator(parameters, seed=seed, generation=generation, individual=individual)


class Strategy:
    """A search by ask and tell, of an experiment or over `genes` genes. It maximizes."""

    def __init__(
        self,
        name: str | None = None,
        *,
        experiment: str | PathLike[str] | None = None,
        genes: int | None = None,
        seed: int = 1,
        condition: str | None = None,
        settings: Mapping[str, Any] | None = None,
    ) -> None:
        values = None if settings is None else dict(settings)
        if (experiment is None) == (genes is None):
            raise ValueError("a strategy needs either an experiment or a number of genes")
        if experiment is not None:
            self._search = Search.of(Problem(fspath(experiment), condition, values, name, seed))
        elif name is not None and genes is not None:
            self._search = Search(name, genes, seed, values)
        else:
            raise ValueError(f"a strategy over {genes} genes needs a name")

    @property
    def generation(self) -> int:
        """The number of the generation that `ask` returns, from 0."""
        return self._search.generation

    @property
    def shape(self) -> tuple[int, int]:
        """The numbers of individuals and of genes."""
        return self._search.shape

    @property
    def score_shape(self) -> tuple[int, int]:
        """The numbers of objectives and measures that `tell` takes for each individual."""
        return self._search.score_shape

    def ask(self) -> NDArray[np.float32]:
        """Returns the parameters of each individual, or the genes of a search without an experiment."""
        return self._search.ask()

    def genes(self) -> NDArray[np.float64]:
        """Returns the genes of each individual. Integer genes are 0 to 65535."""
        return self._search.genes()

    def tell(self, scores: ArrayLike) -> None:
        """Takes the fitness, or the objectives and measures of each individual. NaN is a failure."""
        values = np.asarray(scores)
        if values.ndim == 1:
            values = values[:, None]
        self._search.tell(_matrix(values, np.float64, "scores"))

    def snapshot(self) -> bytes:
        """Returns the state."""
        return self._search.save()

    def restore(self, state: bytes) -> None:
        """Restores a state of the same strategy, settings and seed."""
        self._search.restore(state)

    def archive(self) -> NDArray[np.float64] | None:
        """Returns the archive or front: columns generation, individual, objectives and measures."""
        return self._search.members()
