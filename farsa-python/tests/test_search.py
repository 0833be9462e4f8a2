"""Evaluations, strategies and runs, compared with the command."""

import csv
import json
import subprocess
import sys

import numpy as np
import pytest

import farsa_gym

COMMAND = [sys.executable, "-m", "farsa_gym"]


def test_fitness_equals_that_of_the_command():
    evaluator = farsa_gym.Evaluator("discrimination", threads=2)
    ranges = np.array([[low, high] for _, low, high in evaluator.about["parameters"]])
    generator = np.random.default_rng(3)
    rows = generator.uniform(ranges[:, 0], ranges[:, 1], (7, len(ranges)))
    line = json.dumps({"parameters": rows.tolist(), "seed": 5, "generation": 2, "individual": 4})
    done = subprocess.run(
        [*COMMAND, "evaluate", "discrimination", "--stdin"], input=line, capture_output=True, text=True, check=True
    )
    expected = json.loads(done.stdout.splitlines()[1])
    fitness, notes = evaluator(rows, seed=5, generation=2, individual=4)
    assert fitness.tolist() == expected["fitness"]
    for note, individual in zip(notes, expected["individuals"], strict=True):
        assert note["failed"] is None and note["fitness"] == individual["fitness"]
        for trial, other in zip(note["trials"], individual["trials"], strict=True):
            assert trial["terms"] == other["terms"] and trial["steps"] == other["steps"]
            assert trial["notes"] == other.get("notes", {})
    # Threads and lanes change nothing, and a further call neither.
    alone, _ = farsa_gym.evaluate("discrimination", rows, seed=5, generation=2, individual=4, threads=1, lanes=1)
    assert np.array_equal(alone, fitness) and np.array_equal(evaluator(rows, seed=5, generation=2, individual=4)[0], fitness)
    assert not np.array_equal(evaluator(rows, seed=6)[0], fitness)


def test_genes_are_decoded_over_their_ranges():
    evaluator = farsa_gym.Evaluator("discrimination", threads=1)
    ranges = np.array([[low, high] for _, low, high in evaluator.about["parameters"]])
    ends = evaluator.decode(np.array([[-1.0] * len(ranges), [1.0] * len(ranges)]))
    assert np.array_equal(ends.min(axis=0), ranges[:, 0].astype(np.float32))
    assert np.array_equal(ends.max(axis=0), ranges[:, 1].astype(np.float32))


def test_a_run_by_ask_and_tell_is_the_run_of_the_command(tmp_path):
    settings = {"evolution.population": 10}
    farsa_gym.command(
        ["run", "discrimination", "--strategy", "snes", "--seed", "3", "--generations", "4", "--set",
         "evolution.population=10", "--out", tmp_path / "run", "--quiet"]
    )
    strategy = farsa_gym.Strategy("snes", experiment="discrimination", seed=3, settings=settings)
    evaluator = farsa_gym.Evaluator("discrimination", threads=1)
    run = farsa_gym.load_run(tmp_path / "run")
    curves = run.curves()
    assert (run.experiment, run.strategy, run.seed) == ("discrimination", "snes", 3)
    assert run.settings["evolution.population"] == 10 and "seed = 3" in run.config
    lines = (tmp_path / "run" / "fitness.csv").read_text().splitlines()
    columns = lines[0].split(",")
    for generation in range(4):
        assert strategy.generation == generation
        parameters = strategy.ask()
        assert np.array_equal(parameters, run.parameters(generation))
        fitness, _ = evaluator(parameters, seed=3, generation=generation)
        row = dict(zip(columns, lines[1 + generation].split(","), strict=True))
        assert float(row["best"]) == fitness.max() == curves["best"][generation]
        assert float(row["worst"]) == fitness.min() == curves["worst"][generation]
        assert float(row["mean"]) == curves["mean"][generation]
        strategy.tell(fitness)
    champion = run.champion()
    assert champion["generation"] == 3 and champion["fitness"][0] == curves["best"][3]
    assert np.array_equal(champion["parameters"][0], run.parameters(3)[champion["individuals"][0]])
    # A test, a trial and its page.
    farsa_gym.command(["test", run.path, "--trials", "6", "--quiet"])
    assert run.tests()["fitness"].shape == (6,)
    trial = run.trial(0)
    assert len({column.shape for column in trial.values()}) == 1 and any(name.startswith("sensor.") for name in trial)
    assert run._repr_html_().startswith("<iframe srcdoc=")


# Experiments for strategies that need several populations, demonstrations, objectives or measures.
NEEDED = {
    "cma-me": "reach-grasp-lift",
    "generalist": "predator-prey",
    "learning": "kinesthetic-grasp",
    "map-elites": "reach-grasp-lift",
    "novelty-search": "reach-grasp-lift",
    "nsga2": "reach-grasp-lift",
}


@pytest.mark.parametrize("name", [name for name, _ in farsa_gym.strategies()])
def test_every_strategy_searches_and_restores_its_state(name):
    keywords = {"experiment": NEEDED[name]} if name in NEEDED else {"genes": 6}
    if name == "cma-me":
        # An emitter has a matrix of all genes.
        keywords["settings"] = {"evolution.population": 4, "strategy.emitters": 1}
    strategy = farsa_gym.Strategy(name, seed=2, **keywords)
    generations = 1 if name in ("cma-me", "learning") else 3
    for _ in range(generations):
        genes = strategy.genes()
        assert genes.shape == strategy.shape and np.array_equal(genes, strategy.genes())
        assert strategy.ask().shape == genes.shape and strategy.ask().dtype == np.float32
        fitness = -np.sum((genes / max(1.0, genes.max())) ** 2, axis=1, keepdims=True)
        strategy.tell(np.tile(fitness, (1, sum(strategy.score_shape))))
    assert strategy.generation == generations
    state = strategy.snapshot()
    following = strategy.genes()
    other = farsa_gym.Strategy(name, seed=2, **keywords)
    other.restore(state)
    assert np.array_equal(other.genes(), following) and other.snapshot() == state
    if name in ("cma-me", "map-elites", "nsga2"):
        archive = strategy.archive()
        assert archive.shape[0] > 0 and archive.shape[1] == 2 + sum(strategy.score_shape)
    with pytest.raises(ValueError, match="that|wants|needs|behaviour|says|saved|state"):
        other.restore(state + b"?")


def test_a_search_finds_the_optimum():
    strategy = farsa_gym.Strategy("cma-es", genes=4, seed=1)
    for _ in range(80):
        genes = strategy.genes()
        strategy.tell(-np.sum((genes - 0.25) ** 2, axis=1))
    assert np.abs(strategy.genes() - 0.25).max() < 1e-2


def test_an_archive_is_an_array():
    assert farsa_gym.Strategy("cma-es", genes=4).archive() is None


def test_the_command_is_complete(tmp_path):
    assert "hopper" in farsa_gym.command(["list"])
    assert farsa_gym.command(["info", "nothing"], check=False) == ""
    rows = list(csv.reader(farsa_gym.command(["list"]).splitlines()))
    assert len(rows) > 20
