"""Compares two tables of farsa-bbob and pycma.py: `ratio.py OURS.csv THEIRS.csv` prints Markdown.

The ratio of evaluations is a geometric mean over the problems that both solve; how many each solves stands beside it.
"""

import csv
import math
import sys


def read(path):
    with open(path) as file:
        return {
            (int(row["dimension"]), int(row["function"]), int(row["instance"])): (int(row["evaluations"]), row["hit"] == "1")
            for row in csv.DictReader(file)
        }


def line(name, keys, ours, theirs):
    both = [key for key in keys if ours[key][1] and theirs[key][1]]
    solved = [sum(table[key][1] for key in keys) for table in (ours, theirs)]
    logs = [math.log(ours[key][0] / theirs[key][0]) for key in both]
    ratio = f"{math.exp(sum(logs) / len(logs)):.2f}" if logs else "-"
    return f"| {name} | {len(keys)} | {solved[0]} | {solved[1]} | {ratio} |"


def main():
    ours, theirs = read(sys.argv[1]), read(sys.argv[2])
    keys = sorted(ours.keys() & theirs.keys())
    assert keys and ours.keys() == theirs.keys(), "tables of different problems"
    print("| dimension, function | problems | solved, farsa-evo | solved, pycma | ratio of evaluations |")
    print("|---|---|---|---|---|")
    for dimension in sorted({key[0] for key in keys}):
        for function in sorted({key[1] for key in keys}):
            print(line(f"{dimension}, f{function}", [key for key in keys if key[:2] == (dimension, function)], ours, theirs))
        print(line(f"{dimension}, all", [key for key in keys if key[0] == dimension], ours, theirs))
    print(line("all", keys, ours, theirs))


if __name__ == "__main__":
    main()
