"""Processes beside each other on one run."""

import time

from aftermath import EARLY, whole
from content import content, copy, nothing_but, same_run
from program import Lost, kill

# What the one that comes second may say.
SECOND = ("another process", "there is a run", "there is one already", "exists", "already")


def together(farsa, here, lines, **options):
    """Starts commands at once and waits for all."""
    started = [farsa.start(here, line, **options) for line in lines]
    return [farsa.end(process) for process in started]


def one_wins(results):
    """One at least must succeed, and the others say that they are not alone."""
    for result in results:
        result.check()
        if result.code != 0 and not any(word in result.err for word in SECOND):
            raise Lost(f"did not say that it is not alone: {result.said()}", result)
    if all(result.code for result in results):
        raise Lost(f"nobody succeeded: {results[0].said()}", results[0])


def two_runs(campaign, experiment):
    """Two fresh runs on one --out."""
    reference = campaign.reference(experiment)

    def try_it(here):
        results = together(campaign.farsa, here, [experiment.begin()] * 2, clock="slow")
        one_wins(results)
        whole(here, reference, results[0])

    return try_it


def two_resumes(campaign, experiment):
    """Two that go on with one run."""
    reference = campaign.reference(experiment)
    half = campaign.reference(experiment.of(experiment.generations // 2))

    def try_it(here):
        copy(half / "r", here / "r")
        results = together(campaign.farsa, here, [experiment.resume()] * 2, clock="slow")
        one_wins(results)
        whole(here, reference, results[0])

    return try_it


def two_replications(campaign, experiment):
    """Two that share three replications, and are started again until all is done."""
    farsa = campaign.farsa
    line = [*experiment.begin(), "--replications", "3"]
    alone = campaign.scratch("references", f"{experiment.name} replications")
    farsa.succeed(alone, line)

    def try_it(here):
        results = together(farsa, here, [line] * 2, clock="slow")
        one_wins(results)
        last = farsa.succeed(here, line)
        nothing_but(here, ["r"], last)
        same_run(here, alone, last)

    return try_it


def several_tests(campaign, experiment):
    """Three tests of one run, whose two files must be of one and the same."""
    farsa, reference = campaign.farsa, campaign.reference(experiment)
    lines = [
        ["test", "r", "--trials", "3", "--seed", str(seed), "--threads", "1", "-q"]
        for seed in (1, 2, 3)
    ]
    files = []
    for seed, line in enumerate(lines):
        alone = campaign.scratch("references", f"{experiment.name} test {seed}")
        copy(reference / "r", alone / "r")
        farsa.succeed(alone, line)
        files.append(content(alone / "r"))

    def try_it(here):
        copy(reference / "r", here / "r")
        results = together(farsa, here, lines)
        for result in results:
            result.check(codes=(0,))
        if content(here / "r") not in files:
            raise Lost("the files are not those of one test", results[0])

    return try_it


def readers(campaign, experiment):
    """Readers of a run that goes on, and saves after each generation."""
    long = experiment.of(60)
    reference = campaign.reference(long)
    farsa = campaign.farsa

    def try_it(here):
        process = farsa.start(here, long.begin(), clock="slow")
        try:
            rounds = 0
            while process.poll() is None:
                reading(farsa, here, experiment)
                rounds += 1
        finally:
            if process.poll() is None:
                kill(process)
        result = farsa.end(process).check(codes=(0,))
        if rounds == 0:
            raise Lost("the run was over before a reader came", result)
        for name in ("test.csv", "test.json", ".test.lock"):
            (here / "r" / name).unlink(missing_ok=True)
        whole(here, reference, result)

    return try_it


def reading(farsa, here, experiment):
    """Each reader once, while the run goes on."""
    for line, target in experiment.readers():
        result = farsa.run(here, line).check()
        if result.code != 0 and not any(why in result.err for why in EARLY):
            raise Lost(f"cannot be read while it goes on: {result.said()}", result)
        if not target.startswith("r/"):
            (here / target).unlink(missing_ok=True)
    time.sleep(0.01)


def run(campaign, experiments):
    """All pairs, so many rounds of each."""
    tests = {
        "two runs on one folder": two_runs,
        "two resumes of one run": two_resumes,
        "two times --replications": two_replications,
        "several tests of one run": several_tests,
        "readers of a run that goes on": readers,
    }
    rounds = campaign.sizes.rounds
    for test, make in tests.items():
        cases = []
        for experiment in experiments:
            try_it = make(campaign, experiment)
            count = max(1, rounds // 4) if make is readers else rounds
            cases += [(f"{experiment.name} {number}", try_it) for number in range(count)]
        campaign.attempts(test, cases)
