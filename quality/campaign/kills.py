"""Kills at every system call of a run, as it begins and as it is gone on with."""

from aftermath import after, as_saved, complete, read
from calls import KILLED
from content import copy
from phases import phases
from program import Lost


def kill(campaign, experiment, before, arguments, call):
    """A function of a folder that kills a run at a call and goes on with it."""
    reference, farsa = campaign.reference(experiment), campaign.farsa
    inject = "{}:signal=KILL:when={}".format(*call)

    def try_it(here):
        if before:
            copy(before / "r", here / "r")
        result = farsa.run(here, arguments, inject=inject, clock="slow")
        if result.code != -9:
            raise Lost(f"was not killed but ended with {result.code}: {result.said()}", result)
        with after(result):
            read(farsa, here, experiment)
            as_saved(campaign, here, experiment)
            complete(farsa, here, experiment, reference)
            read(farsa, here, experiment, finished=True)

    return try_it


def run(campaign, experiments):
    """All of them."""
    for experiment in experiments:
        for phase, before, arguments, found in phases(campaign, experiment, KILLED):
            chosen = campaign.choose(found, campaign.sizes.kills)
            campaign.attempts(
                f"kills at system calls, {experiment.name}, {phase}",
                [
                    ("{} {}".format(*call), kill(campaign, experiment, before, arguments, call))
                    for call in chosen
                ],
            )
