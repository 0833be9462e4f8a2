"""What must hold of a run after something happened to it."""

import json
import shutil
from contextlib import contextmanager

from content import copy, forget_tests, nothing_but, same_run
from program import Lost

# What a reader may say of a run that has not come to its first save.
EARLY = ("no generation is finished yet", "there is no such directory", "there is none")


@contextmanager
def after(result):
    """What is lost within names this command, too, as the one that came before."""
    try:
        yield
    except Lost as lost:
        lost.command = f"{result.command}\n  then:    {lost.command}"
        raise


def read(program, here, experiment, finished=False):
    """All readers give a result or say why not, and change nothing of the run."""
    for arguments, target in experiment.readers():
        result = program.run(here, arguments).check()
        if result.code != 0 and (finished or not any(why in result.err for why in EARLY)):
            raise Lost(f"cannot be read: {result.said()}", result)
        path = here / target
        if (result.code == 0) != path.exists():
            raise Lost(f"ended with {result.code}, and {target} is {path.exists()}", result)
        if not target.startswith("r/"):
            path.unlink(missing_ok=True)
    if (here / "r").exists():
        forget_tests(here / "r")


def as_saved(campaign, here, experiment):
    """Resumed without a generation more, a run is one of as many generations as were saved."""
    if not (here / "r").exists():
        return
    line = ["report", "r", "--html", "page.html", "--json", "-q"]
    result = campaign.farsa.run(here, line).check()
    if result.code != 0:
        return
    (here / "page.html").unlink()
    saved = experiment.of(json.loads(result.out)["runs"][0]["generations"])
    aside = here / "saved"
    aside.mkdir()
    copy(here / "r", aside / "r")
    result = campaign.farsa.succeed(aside, saved.resume())
    whole(aside, campaign.reference(saved), result)
    shutil.rmtree(aside)


def complete(program, here, experiment, reference, **options):
    """Goes on with a run, or begins it, and compares it with the one that nothing happened to."""
    begun = (here / "r").exists()
    arguments = experiment.resume() if begun else experiment.begin()
    result = program.succeed(here, arguments, **options)
    whole(here, reference, result)


def whole(here, reference, result):
    """The run is the one that nothing happened to, and nothing lies beside it."""
    nothing_but(here, ["r"], result)
    same_run(here / "r", reference / "r", result)
