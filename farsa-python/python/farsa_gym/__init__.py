"""Experiments of FARSA as Gymnasium environments, with its strategies and runs."""

import sys

from ._farsa_gym import experiments, strategies
from .runs import Run, command, load_run
from .searches import Evaluator, Strategy, describe, evaluate

__all__ = [
    "Env",
    "Evaluator",
    "Run",
    "Strategy",
    "VectorEnv",
    "command",
    "describe",
    "evaluate",
    "experiments",
    "load_run",
    "make",
    "make_vec",
    "strategies",
]

# `python -m farsa_gym` runs the command, which needs no Gymnasium.
if sys.argv[:1] != ["-m"]:
    from .environments import Env, VectorEnv, make, make_vec, register_all

    register_all()
