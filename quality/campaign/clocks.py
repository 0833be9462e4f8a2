"""Clocks that go backwards, jump, or are wrong by decades: no byte of a run depends on them."""

from aftermath import whole
from content import copy

CLOCKS = ["slow", "back", "jumps", "ancient"]


def wrong(campaign, experiment, clock, after):
    """A function of a folder in which a run has a wrong clock."""
    reference = campaign.reference(experiment)
    half = campaign.reference(experiment.of(experiment.generations // 2))

    def try_it(here):
        if after:
            copy(half / "r", here / "r")
        arguments = experiment.resume() if after else experiment.begin()
        result = campaign.farsa.succeed(here, arguments, clock=clock)
        whole(here, reference, result)

    return try_it


def run(campaign, experiments):
    """Each clock over each experiment, of a few generations and of more."""
    cases = []
    for experiment in experiments:
        for factor in range(1, campaign.sizes.clocks + 1):
            longer = experiment.of(factor * experiment.generations)
            for clock in CLOCKS:
                for after in (False, True):
                    label = f"{experiment.name} {longer.generations} {clock} {after}"
                    cases.append((label, wrong(campaign, longer, clock, after)))
    campaign.attempts("clocks that jump", cases)
