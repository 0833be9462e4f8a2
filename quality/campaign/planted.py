"""Programs with planted faults, each of which a test of the campaign must report as lost."""

from campaign import Campaign, Sizes
from experiments import ONE
from long_runs import flat
from order import Disk
from program import Lost
from table import Table

# What a wrapper does around the true program, which is FARSA; the test that must see it, and a word
# of what that must say.
PLANTED = {
    "none": ("kills", "", 'exec FARSA "$@"'),
    "a log that is cut after a resume": (
        "kills",
        "other bytes",
        'case "$*" in *--resume*) FARSA "$@" && printf x > r/fitness.csv ;;'
        ' *) exec FARSA "$@" ;; esac',
    ),
    "a stray file beside the run": (
        "kills",
        "in the folder are",
        'case "$*" in *--resume*) : > .r.left ;; esac; exec FARSA "$@"',
    ),
    "a reader that panics": (
        "kills",
        "ended with 101",
        'case "$*" in replay*) echo "thread panicked" >&2; exit 101 ;; esac; exec FARSA "$@"',
    ),
    "a reader that fails without a word": (
        "kills",
        "without a word",
        'case "$*" in replay*) exit 1 ;; esac; exec FARSA "$@"',
    ),
    "an error that is passed over": (
        "errors",
        "missing files",
        'case "$*" in "run disc"*) FARSA "$@" 2>/dev/null; exit 0 ;; esac; exec FARSA "$@"',
    ),
    "half a page": (
        "results",
        "neither old nor new",
        'case "$*" in *page.html*) FARSA "$@" && exit; code=$?; printf half > page.html;'
        ' exit $code ;; *) exec FARSA "$@" ;; esac',
    ),
    "a draft of a page that stays": (
        "results",
        "stray file",
        'case "$*" in *page.html*) : > .page.html.left$$ ;; esac; exec FARSA "$@"',
    ),
    "a second process that is let in": (
        "processes",
        "in the folder are",
        'case "$*" in run*) FARSA "$@" || : > left; exit 0 ;; esac; exec FARSA "$@"',
    ),
    "a byte that depends on the clock": (
        "clocks",
        "other bytes",
        'FARSA "$@" || exit; case "$CAMPAIGN_CLOCK" in back) printf x >> r/fitness.svg ;; esac',
    ),
    "a file that is gone after a random kill": (
        "moments",
        "missing files",
        'case "$*" in *--resume*) FARSA "$@"; code=$?; rm -f r/fitness.svg; exit $code ;; esac;'
        ' exec FARSA "$@"',
    ),
}
SMALL = Sizes(kills=4, errors=12, results=3, disks=2, rounds=1, clocks=1, moments=6)


def wrapper(folder, name, text, farsa):
    """A program that runs the true one, with a fault."""
    path = folder / f"{name.replace(' ', '-')}.sh"
    path.write_text("#!/bin/sh\n" + text.replace("FARSA", f"'{farsa}'") + "\n")
    path.chmod(0o755)
    return path


def growing_memory_is_seen():
    """Whether a process that leaves 100 bytes a generation is one, and none that leaves two."""

    def grows(each):
        samples = [(100 * number, (10 << 20) + 100 * each * number) for number in range(1, 100)]
        try:
            flat(samples, None, 16)
        except Lost:
            return True
        return False

    return grows(100) and not grows(2)


def early_rename_is_seen():
    """Whether a rename before its synchronisation is one, and none after it."""
    calls = [
        ("openat", 'AT_FDCWD, ".a.new", O_RDWR', 3),
        ("write", '3, "x", 1', 1),
        ("fsync", "3", 0),
        ("rename", '".a.new", "a"', 0),
        ("openat", 'AT_FDCWD, ".", O_RDONLY', 4),
        ("fsync", "4", 0),
    ]

    def early(calls):
        disk = Disk("/here")
        try:
            for call in calls:
                disk.call(*call)
        except Lost:
            return True
        return bool(disk.renamed)

    without = [calls[:number] + calls[number + 1 :] for number in (2, 5)]
    return not early(calls) and all(early(fewer) for fewer in without)


def run(farsa, clock, folder, tests):
    """Returns what was planted and not seen as what it is; the honest wrapper must lose nothing."""
    checks = {"memory that grows": growing_memory_is_seen, "early renames": early_rename_is_seen}
    unseen = [name for name, seen in checks.items() if not seen()]
    for name, (test, words, text) in PLANTED.items():
        table = Table(quiet=True)
        program = wrapper(folder, name, text, farsa)
        campaign = Campaign([program], clock, folder / name.replace(" ", "-"), table, SMALL)
        try:
            tests[test](campaign, [ONE])
        except Lost as lost:
            table.reasons.append(str(lost))
        reasons = table.reasons
        seen = any(words in why for why in reasons) if words else not table.losses()
        print(f"planted: {name}: {'as it should' if seen else 'NOT SEEN'}", flush=True)
        if not seen:
            unseen.append(name)
            print("".join(f"  {why}\n" for why in reasons), end="")
    return unseen
