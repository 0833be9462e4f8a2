"""Commands that write results: their files are whole or not there, whatever happens to them."""

from dataclasses import dataclass, field

from calls import FAILED, KILLED, calls
from content import content, copy
from errors import faults, label
from program import Lost


@dataclass
class Command:
    """A command; `older` makes files that are there before it."""

    name: str
    arguments: list
    older: list = field(default_factory=list)


def commands(experiment):
    """Those of the campaign."""
    test = ["test", "r", "--trials", "2", "--threads", "1", "-q"]
    report = ["report", "r", "--html", "page.html", "-q"]
    replay = ["replay", "r", "--trial", "0", "--html", "page.html", "-q"]
    older = ["replay", "r", "--html", "page.html", "-q"]
    return [
        Command("test", test),
        Command("test once more", test, [*test, "--seed", "2"]),
        Command("report", [*report, "--md", "page.md"]),
        Command("replay", replay),
        Command("replay over a page", replay, older),
        Command("live", ["live", "r", "--html", "page.html", "-q"]),
        Command("export", experiment.export),
        Command("draw", ["draw", "r", "--size", "60x40", "--out", "end.png", "-q"]),
        Command("merge", ["merge", "r", "--out", "all", "--csv", "runs.csv", "-q"]),
    ]


def is_draft(name):
    """Whether a file or folder is one that has not got its name yet."""
    return name.startswith(".") and name.endswith(".new")


class Results:
    """A command on a finished run: the files before it and after it."""

    def __init__(self, campaign, experiment, command):
        self.campaign, self.command, self.farsa = campaign, command, campaign.farsa
        self.run = campaign.reference(experiment) / "r"
        here = campaign.scratch("traces", f"results {command.name}")
        self.prepare(here)
        self.before = content(here)
        self.farsa.succeed(here, command.arguments)
        self.after = content(here)
    def prepare(self, here):
        """The folder before the command."""
        copy(self.run, here / "r")
        if self.command.older:
            self.farsa.succeed(here, self.command.older)

    def calls(self, wanted):
        """The system calls of the command."""
        here = self.campaign.scratch("traces", f"results {self.command.name}")
        self.prepare(here)
        return calls(self.farsa, here, self.command.arguments, wanted)[0]

    def judge(self, here, result, drafts):
        """Loses files that are neither those of before nor of after; drafts may lie there."""
        found = content(here)
        for name, data in found.items():
            if data not in (self.before.get(name), self.after.get(name)):
                if drafts and any(map(is_draft, name.split("/"))):
                    continue
                if name in self.after:
                    raise Lost(f"{name} is neither old nor new ({len(data)} bytes)", result)
                raise Lost(f"stray file {name}", result)
        missing = sorted(set(self.before) - set(found))
        if missing:
            raise Lost(f"{missing} are gone", result)
        if result.code == 0 and found != self.after:
            raise Lost("ended with 0 without its files", result)

    def again(self, here, result):
        """The same command then does all, and nothing else lies there."""
        if not self.command.older:
            for name in set(self.after) - set(self.before):
                (here / name).unlink(missing_ok=True)
                folder = (here / name).parent
                while folder != here and folder.is_dir() and not any(folder.iterdir()):
                    folder.rmdir()
                    folder = folder.parent
        last = self.farsa.succeed(here, self.command.arguments)
        last.command = f"{result.command}\n  then:    {last.command}"
        self.judge(here, last, drafts=False)

    def attack(self, inject):
        """A function of a folder that injects a fault, which is a kill or an error."""
        killed = "signal=KILL" in inject

        def try_it(here):
            self.prepare(here)
            result = self.farsa.run(here, self.command.arguments, inject=inject)
            if killed and result.code != -9:
                raise Lost(f"was not killed but ended with {result.code}", result)
            if not killed:
                result.check(silent=inject.startswith("write"))
            # Where no folder can be opened any more, none can be removed.
            self.judge(here, result, drafts=killed or inject.endswith("+"))
            self.again(here, result)

        return try_it


def run(campaign, experiment):
    """All commands, killed and with errors."""
    for command in commands(experiment):
        results = Results(campaign, experiment, command)
        kills = [f"{name}:signal=KILL:when={n}" for name, n in results.calls(KILLED)]
        failures = [inject for _, inject in faults(results.calls(FAILED))]
        for kind, injected in (("kills", kills), ("errors", failures)):
            chosen = campaign.choose(injected, campaign.sizes.results)
            cases = [(label(inject), results.attack(inject)) for inject in chosen]
            campaign.attempts(f"results, {command.name}, {kind}", cases)
