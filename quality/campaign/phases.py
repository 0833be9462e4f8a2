"""A run as it begins and as it is gone on with, each with its system calls."""

from calls import calls
from content import copy


def phases(campaign, experiment, wanted):
    """For each: its name, what lies there before, the arguments, and the calls."""
    half = campaign.reference(experiment.of(max(1, experiment.generations // 2)))
    beginning = ("begin", None, experiment.begin())
    for phase, before, arguments in (beginning, ("resume", half, experiment.resume())):
        here = campaign.scratch("traces", f"{experiment.name} {phase}")
        if before:
            copy(before / "r", here / "r")
        found, result = calls(campaign.farsa, here, arguments, wanted, clock="slow")
        result.check(codes=(0,))
        yield phase, before, arguments, found
