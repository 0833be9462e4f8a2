#!/usr/bin/env python3
"""The table of a results.csv of `compare`: python3 table.py RESULTS.csv [STRATEGY]; needs scipy.

Medians and quartiles (between neighbours, as `farsa report` has them) of the champions' fitness in a test; p is Mann-Whitney's,
two-sided, against the experiment's own strategy or that which is named.
"""

import csv
import statistics
import sys

from scipy.stats import mannwhitneyu

groups = {}
for row in csv.DictReader(open(sys.argv[1])):
    groups.setdefault(row["strategy"], []).append((float(row["test fitness"]), float(row["test success"])))
baseline = sys.argv[2] if len(sys.argv) > 2 else "own"
own = [fitness for fitness, _ in groups[baseline]]
print("| strategy | runs | fitness: median (quartiles) | trials that succeed, median | p |")
print("|---|---|---|---|---|")
for strategy, runs in groups.items():
    fitness, success = zip(*runs)
    low, median, high = statistics.quantiles(fitness, n=4, method="inclusive")
    p = "" if strategy == baseline else f"{mannwhitneyu(fitness, own, alternative='two-sided').pvalue:.2g}"
    print(f"| `{strategy}` | {len(runs)} | {median:.3f} ({low:.3f} to {high:.3f}) | {statistics.median(success):.3f} | {p} |")
