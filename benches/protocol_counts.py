"""Counts successes by case of a test protocol in finished runs, a line a run and case.

    python benches/protocol_counts.py PROTOCOL RUN [RUN ...] > counts.csv

Each RUN is a directory of `farsa run` after `farsa test RUN --protocol PROTOCOL`.
"""

import csv
import json
import pathlib
import sys


def counts(run: pathlib.Path, protocol: str):
    manifest = json.loads((run / "manifest.json").read_text())
    cases = {}
    with open(run / "protocols" / f"{protocol}.csv", newline="") as file:
        for row in csv.DictReader(file):
            case = cases.setdefault(int(row["case"]), [row["row"], row["column"], row["held_out"], 0, 0, 0.0])
            case[3] += 1
            case[4] += row["success"] == "true"
            case[5] += float(row["fitness"])
    for _, (row, column, held_out, trials, successes, fitness) in sorted(cases.items()):
        yield [manifest["condition"], manifest["seed"], row, column, held_out, trials, successes, f"{fitness / trials:.4f}"]


def main() -> None:
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    protocol, runs = sys.argv[1], [pathlib.Path(run) for run in sys.argv[2:]]
    writer = csv.writer(sys.stdout, lineterminator="\n")
    writer.writerow(["condition", "seed", "row", "column", "held_out", "trials", "successes", "mean_fitness"])
    for run in runs:
        writer.writerows(counts(run, protocol))


if __name__ == "__main__":
    main()
