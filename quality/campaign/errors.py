"""Errors of the operating system, injected into every call that changes files."""

from aftermath import after, complete, read, whole
from calls import FAILED
from content import copy
from phases import phases

ERRORS = ["ENOSPC", "EIO", "EACCES", "EROFS", "EDQUOT", "EMFILE"]


def faults(found):
    """Each error at each call, once and from then on; what is read can only be unreadable."""
    return [
        (name, f"{name}:error={error}:when={number}{more}")
        for name, number in found
        for error in (ERRORS if name != "read" else ["EIO"])
        for more in ("", "+")
    ]


def label(inject):
    """A name for a folder."""
    return inject.replace(":error=", " ").replace(":signal=", " ").replace(":when=", " ")


def fail(campaign, experiment, before, arguments, fault):
    """A function of a folder that has a call of a run fail, and goes on with it."""
    reference, farsa = campaign.reference(experiment), campaign.farsa
    name, inject = fault

    def try_it(here):
        if before:
            copy(before / "r", here / "r")
        result = farsa.run(here, arguments, inject=inject, clock="slow")
        # It cannot say what is wrong if that very call fails.
        result.check(silent=name == "write")
        with after(result):
            if result.code == 0:
                whole(here, reference, result)
            read(farsa, here, experiment)
            complete(farsa, here, experiment, reference)

    return try_it


def run(campaign, experiments):
    """All of them."""
    for experiment in experiments:
        for phase, before, arguments, found in phases(campaign, experiment, FAILED):
            chosen = campaign.choose(faults(found), campaign.sizes.errors)
            campaign.attempts(
                f"errors at system calls, {experiment.name}, {phase}",
                [
                    (label(fault[1]), fail(campaign, experiment, before, arguments, fault))
                    for fault in chosen
                ],
            )
