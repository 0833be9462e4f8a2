"""Kills at random moments, over threads and over ranks of MPI."""

import os
import shutil
import signal
import subprocess
from pathlib import Path

from aftermath import read, whole
from program import Lost, Program, kill

THREADS = (1, 2, 8)
LONG = 60


def life(campaign, program, test, experiment, end_of, delays):
    """A run that is killed again and again until it is finished; returns how many kills it took."""
    here = campaign.scratch(test, experiment.name)
    long = experiment.of(LONG)
    reference = campaign.reference(long)
    kills = 0
    try:
        while True:
            threads = campaign.random.choice(THREADS)
            begun = (here / "r").exists()
            line = long.resume(threads=threads) if begun else long.begin(threads=threads)
            process = program.start(here, line, clock="slow")
            finished = end_of(process, delays(kills))
            result = program.end(process)
            if finished:
                result.check(codes=(0,))
                whole(here, reference, result)
                shutil.rmtree(here)
                return kills
            kills += 1
            campaign.table.survived(test)
            if kills % 7 == 0:
                read(campaign.farsa, here, experiment)
    except Lost as lost:
        campaign.table.lost(test, f"after {kills} kills: {lost}", lost.command, here)
        return max(kills, 1)


def killed_in_time(process, seconds):
    """Waits and kills; whether the process had ended by itself."""
    if ended(process, seconds):
        return True
    kill(process)
    return False


def children(process):
    """The processes that it has started, and those have."""
    found, front = [], [process.pid]
    while front:
        parent = front.pop()
        for task in Path(f"/proc/{parent}/task").glob("*/children"):
            try:
                own = [int(word) for word in task.read_text().split()]
            except OSError:
                own = []
            found += own
            front += own
    return found


def rank_killed(campaign):
    """A function that kills one rank of several, and whatever then does not end."""

    def end_of(process, seconds):
        if ended(process, seconds):
            return True
        started = children(process)
        ranks = [pid for pid in started if named(pid, "farsa-mpi")]
        signal_all(campaign.random.sample(ranks, min(1, len(ranks))) or [process.pid])
        # Open MPI 4 may hang after all ranks are gone.
        if not ended(process, 10):
            kill(process)
        signal_all(pid for pid in started if named(pid, "farsa-mpi"))
        return False

    return end_of


def ended(process, seconds):
    """Whether a process ends in this time."""
    try:
        process.wait(seconds)
    except subprocess.TimeoutExpired:
        return False
    return True


def signal_all(processes):
    """Kills processes that may have ended."""
    for pid in processes:
        try:
            os.kill(pid, signal.SIGKILL)
        except ProcessLookupError:
            pass


def named(pid, name):
    """Whether a process has this name."""
    try:
        return Path(f"/proc/{pid}/comm").read_text().strip() == name
    except OSError:
        return False


def run(campaign, experiments):
    """So many kills, shared among the experiments."""
    test = "random kills, threads 1, 2, 8"
    left = campaign.sizes.moments
    campaign.table.begin(test)

    def delays(_):
        return campaign.random.random() * campaign.random.choice((0.02, 0.1, 0.4))

    while left > 0:
        for experiment in experiments:
            if left > 0:
                end_of = killed_in_time
                left -= life(campaign, campaign.farsa, test, experiment, end_of, delays)
    campaign.table.say(campaign.table.line(test))


def run_ranks(campaign, experiments):
    """The same with one rank of three that is killed."""
    test = "random kills, ranks"
    if not campaign.ranks:
        campaign.table.not_run(test, "no --ranks")
        return
    words = ["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", "3", campaign.ranks]
    program = Program(words, campaign.farsa.clock)
    left = campaign.sizes.ranks
    campaign.table.begin(test)

    def delays(_):
        return campaign.random.random() * campaign.random.choice((0.3, 1.0))

    while left > 0:
        for experiment in experiments[:2]:
            if left > 0:
                end_of = rank_killed(campaign)
                left -= life(campaign, program, test, experiment, end_of, delays)
    campaign.table.say(campaign.table.line(test))
