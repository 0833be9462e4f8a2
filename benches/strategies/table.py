#!/usr/bin/env python3
"""The table of a results.csv of `compare`: python3 table.py RESULTS.csv [STRATEGY]; needs scipy.

Medians and quartiles (between neighbors, as in `farsa report`) of the champions' fitness in a test. The interval contains the
median with at least 95 % (order statistics). p is the two-sided Mann-Whitney test against the experiment's own strategy or the
named one.
"""

import csv
import statistics
import sys

from scipy.stats import binom, mannwhitneyu


def interval(values):
    """The narrowest pair of order statistics that contains the median with at least 95 %."""
    # The number of values below the median is binomial with p = 1/2.
    rank = max(int(binom.ppf(0.025, len(values), 0.5)), 1)
    values = sorted(values)
    return values[rank - 1], values[-rank]


groups = {}
for row in csv.DictReader(open(sys.argv[1])):
    groups.setdefault(row["strategy"], []).append((float(row["test fitness"]), float(row["test success"])))
baseline = sys.argv[2] if len(sys.argv) > 2 else "own"
own = [fitness for fitness, _ in groups[baseline]]
print("| strategy | runs | fitness: median (quartiles) | interval | trials that succeed, median | p |")
print("|---|---|---|---|---|---|")
for strategy, runs in groups.items():
    fitness, success = zip(*runs)
    low, median, high = statistics.quantiles(fitness, n=4, method="inclusive")
    p = "" if strategy == baseline else f"{mannwhitneyu(fitness, own, alternative='two-sided').pvalue:.2g}"
    least, most = interval(fitness)
    columns = [f"`{strategy}`", len(runs), f"{median:.3f} ({low:.3f} to {high:.3f})", f"{least:.3f} to {most:.3f}"]
    print("| " + " | ".join(map(str, columns)), end="")
    print(f" | {statistics.median(success):.3f} | {p} |")
