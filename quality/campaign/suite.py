"""The tests in their order."""

import copy

import clocks
import disks
import errors
import kills
import long_runs
import moments
import order
import planted
import processes
import results
from campaign import QUICK, Campaign, Sizes
from experiments import EXPERIMENTS, FAILING, ONE
from program import Lost, Program, compile_clock
from table import Table


def run_failing(campaign, _):
    """Kills and errors in a run with failing trials, by a program of its own."""
    if not campaign.failing:
        campaign.table.not_run("failing trials", "no --failing")
        return
    other = copy.copy(campaign)
    other.farsa = Program([campaign.failing], campaign.farsa.clock)
    kills.run(other, [FAILING])
    errors.run(other, [FAILING])
    order.run(other, [FAILING])


TESTS = {
    "kills": kills.run,
    "errors": errors.run,
    "failing": run_failing,
    "results": lambda campaign, _: results.run(campaign, ONE),
    "disks": disks.run,
    "processes": processes.run,
    "order": order.run,
    "clocks": clocks.run,
    "moments": moments.run,
    "ranks": moments.run_ranks,
    "memory": lambda campaign, _: long_runs.run_memory(campaign),
    "soak": lambda campaign, _: long_runs.run_soak(campaign),
}


def run(chosen, folder):
    """Runs tests as the command line has it; returns what was lost."""
    clock, table = compile_clock(folder), Table()
    sizes = QUICK if chosen.quick else Sizes()
    if chosen.soak:
        sizes.soak = chosen.soak
    farsa = [chosen.farsa.resolve()]
    campaign = Campaign(farsa, clock, folder, table, sizes, chosen.jobs, chosen.seed)
    campaign.failing = chosen.failing and chosen.failing.resolve()
    campaign.ranks = chosen.ranks and chosen.ranks.resolve()
    for name in chosen.only.split(",") if chosen.only else TESTS:
        try:
            TESTS[name](campaign, EXPERIMENTS[: chosen.experiments])
        except Lost as lost:
            table.lost(name, f"cannot begin: {lost}", lost.command, folder)
    table.print()
    return table.losses()


def self_test(chosen, folder):
    """Tries the tests on programs with planted faults; returns what was not seen."""
    return planted.run(chosen.farsa.resolve(), compile_clock(folder), folder, TESTS)
