"""Long runs: memory that stays flat, and hours of evaluations that fail."""

import signal

from content import nothing_but
from experiments import COLLECTION, ONE, SEVERAL, settings
from memory import slope, watch
from program import Lost, Program

# What a generation may leave in memory [byte], and how many generations of these runs there are for
# one of the first. Little but noise: nothing stays of a generation, but that several
# populations keep the champions that they still meet (docs/command.md).
SHARES = [(ONE, 16, 1), (SEVERAL, 2000, 25), (COLLECTION, 16, 50)]
# What a run may take beside that [byte].
BASE = 24 << 20
# With fewer generations nothing is seen.
FEWEST = 10_000


def flat(samples, result, row):
    """Loses a run whose memory grows by more than so many bytes a generation."""
    if len(samples) < 10:
        raise Lost(f"only {len(samples)} samples: it ended too early", result)
    generations, memory = samples[-1]
    each = slope(samples)
    said = f"{memory >> 10} KiB after {generations} generations, {each or 0:.0f} bytes a generation"
    if each is None or each > row or memory > BASE + row * generations:
        raise Lost(f"memory grows: {said}", result)
    return said


def long_run(campaign, experiment, row):
    """A function of a folder in which a run goes on for very many generations."""

    def try_it(here):
        process = campaign.farsa.start(here, experiment.begin())
        samples = watch(process, here / "r" / "fitness.csv")
        result = campaign.farsa.end(process).check(codes=(0,))
        campaign.table.say(f"{experiment.name}: {flat(samples, result, row)}")

    return try_it


def run_memory(campaign):
    """So many generations of the fastest run, and fewer of others; of each the shortest trials."""
    cases = []
    for experiment, row, share in SHARES:
        longer = experiment.of(campaign.sizes.generations // share)
        longer.arguments = [*experiment.arguments, *settings("trial.count=1", "trial.steps=1")]
        if longer.generations >= FEWEST:
            label = f"{experiment.name} {longer.generations}"
            cases.append((label, long_run(campaign, longer, row)))
    campaign.attempts("memory of a long run", cases)


def faulty(steps, generations, out, threads):
    """The words of a run whose trials fail at a rate."""
    settings = ["--set", "fault.rate=0.02", "--set", f"trial.steps={steps}"]
    numbers = ["--generations", str(generations), "--threads", str(threads)]
    return ["run", "faulty", *settings, *numbers, "--out", out, "-q"]


def column(text, name):
    """A column of a table, as words."""
    lines = text.splitlines()
    at = lines[0].split(",").index(name)
    return [line.split(",")[at] for line in lines[1:]]


def soak(campaign):
    """A function of a folder in which a run with failing trials goes on for so long."""
    seconds = campaign.sizes.soak
    steps = 1000 if seconds < 600 else 50_000
    program = Program([campaign.failing], campaign.farsa.clock)

    def try_it(here):
        process = program.start(here, faulty(steps, 100_000_000, "r", 2))
        log = here / "r" / "fitness.csv"
        samples = watch(process, log, seconds)
        process.send_signal(signal.SIGINT)
        result = program.end(process)
        result.check(codes=(130,))
        # In a few seconds there are too few generations for a slope.
        said = flat(samples, result, 400 if seconds < 600 else 16)
        rows = log.read_text()
        finished = len(rows.splitlines()) - 1
        failed = sum(int(word) for word in column(rows, "failed"))
        listed = (here / "r" / "failures.csv").read_bytes().count(b"\n") - 1
        if failed == 0 or failed != listed:
            raise Lost(f"{failed} failed evaluations in the log, {listed} in failures.csv", result)
        program.succeed(here, ["run", "--resume", "r", "--generations", str(finished + 5), "-q"])
        program.succeed(here, ["test", "r", "--trials", "50", "-q"])
        start = program.succeed(here, faulty(steps, 100, "start", 1))
        first = (here / "start" / "fitness.csv").read_text()
        if not log.read_text().startswith(first):
            raise Lost("the first generations are others on one thread", start)
        nothing_but(here, ["r", "start"], start)
        campaign.table.say(f"soak: {failed} failed evaluations, {said}")

    return try_it


def run_soak(campaign):
    """So many seconds."""
    test = "soak with failing evaluations"
    if not campaign.failing:
        campaign.table.not_run(test, "no --failing")
        return
    campaign.attempts(test, [(f"{campaign.sizes.soak} s", soak(campaign))])
