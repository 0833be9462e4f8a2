"""A table of all runs, and how the conditions compare, from counts of successes.

    python benches/compositional_instructions.py docs/results/compositional-instructions.csv

The counts are those that `benches/protocol_counts.py instructions RUN...` prints. Standard library alone.
"""

import csv
import math
import sys

CONDITIONS = ("with-indicate", "with-ignore")
COLORS = ("red", "green", "blue")
HELD_OUT = (("TOUCH", "green"), ("MOVE", "red"))
# Shares of the trials: of an instruction that was held out, to generalise; of each that was trained, to follow all seven.
GENERALISES = 0.75
FOLLOWS = 0.80


def read(path):
    """Share of successes by condition, seed and instruction."""
    runs = {}
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            shares = runs.setdefault((row["condition"], int(row["seed"])), {})
            held_out = (row["row"], row["column"]) in HELD_OUT
            if held_out != (row["held_out"] == "true"):
                sys.exit(f"{path}: {row['row']} {row['column']} of seed {row['seed']} is not held out as the others are")
            shares[row["row"], row["column"]] = int(row["successes"]) / int(row["trials"])
    for (condition, seed), shares in runs.items():
        if len(shares) != 9:
            sys.exit(f"{path}: {condition} {seed} has {len(shares)} instructions, not 9")
    return runs


def fisher(first, second):
    """Fisher's exact test, both sides: of all tables with the same sums, those that are no likelier than this one."""
    (a, n), (b, m) = first, second
    ways = lambda k: math.comb(n, k) * math.comb(m, a + b - k)
    possible = range(max(0, a + b - m), min(n, a + b) + 1)
    return sum(ways(k) for k in possible if ways(k) <= ways(a)) / math.comb(n + m, a + b)


def percent(share):
    return f"{100 * share:.0f}"


def main() -> None:
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    runs = read(sys.argv[1])
    print("| condition | seed | INDICATE or IGNORE red, green, blue | TOUCH red, blue | MOVE green, blue "
          "| TOUCH green (held out) | MOVE red (held out) |")
    print("|---|---|---|---|---|---|---|")
    found = {condition: {"runs": 0, "follow": 0, "generalise": 0} for condition in CONDITIONS}
    for condition in CONDITIONS:
        for (other, seed), shares in sorted(runs.items()):
            if other != condition:
                continue
            trained = {of: share for of, share in shares.items() if of not in HELD_OUT}
            third = next(action for action, _ in shares if action not in ("TOUCH", "MOVE"))
            cells = [", ".join(percent(trained[action, color]) for color in COLORS if (action, color) in trained)
                     for action in (third, "TOUCH", "MOVE")]
            cells += [percent(shares[of]) for of in HELD_OUT]
            print(f"| {condition} | {seed} | {' | '.join(cells)} |")
            counts = found[condition]
            counts["runs"] += 1
            counts["follow"] += all(share >= FOLLOWS for share in trained.values())
            counts["generalise"] += any(shares[of] >= GENERALISES for of in HELD_OUT)
    print()
    for condition, counts in found.items():
        print(f"{condition}: of {counts['runs']} runs {counts['follow']} follow each of the seven in {percent(FOLLOWS)} %, "
              f"{counts['generalise']} generalise to one that was held out in {percent(GENERALISES)} %")
    pairs = [(counts["generalise"], counts["runs"]) for counts in found.values()]
    print(f"Fisher's exact test of those that generalise: p = {fisher(*pairs):.3g}")


if __name__ == "__main__":
    main()
