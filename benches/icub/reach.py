"""Tables and the map of docs/results/icub.md from finished runs of `icub-reach` that were tested by its protocols.

    python benches/icub/reach.py RUNS MAP.svg > tables.md

RUNS holds `steady` and `velocity`, each with the runs of `farsa run icub-reach --replications`. Standard library alone.
"""

import csv
import json
import pathlib
import statistics
import sys

CONDITIONS = ("steady", "velocity")
# White to dark red; the scale's end [cm].
WORST = 10.0


def rows(run: pathlib.Path, protocol: str):
    with open(run / "protocols" / f"{protocol}.csv", newline="") as file:
        return list(csv.DictReader(file))


def case_name(row) -> str:
    return " ".join(part for part in (row["row"], row["column"]) if part)


def by_case(run: pathlib.Path, protocol: str):
    """Mean distance [cm] of each case, in order, by name."""
    cases = {}
    for row in rows(run, protocol):
        cases.setdefault(case_name(row), []).append(float(row["distance [cm]"]))
    return {name: statistics.mean(distances) for name, distances in cases.items()}


def seed(run: pathlib.Path) -> int:
    return json.loads((run / "manifest.json").read_text())["seed"]


def mann_whitney(a, b):
    """U of a, and the exact two-sided probability without ties: how many of all orders have a U as far from the middle."""
    u = sum((x > y) + 0.5 * (x == y) for x in a for y in b)
    n, m = len(a), len(b)
    # ways[i][k]: orders of i of the first with a U of k, one of the second after the other.
    ways = [[1] + [0] * (n * m)] + [[0] * (n * m + 1) for _ in range(n)]
    for total in range(1, n + m + 1):
        for i in range(min(n, total), 0, -1):
            below = total - i
            if below <= m:
                ways[i] = [
                    (ways[i][k] if below > 0 else 0) + (ways[i - 1][k - below] if k >= below else 0)
                    for k in range(n * m + 1)
                ]
    counts = ways[n]
    far = abs(u - n * m / 2)
    return u, sum(c for k, c in enumerate(counts) if abs(k - n * m / 2) >= far) / sum(counts)


def color(distance: float) -> str:
    share = min(distance / WORST, 1.0)
    return "#" + "".join(f"{round(a + (b - a) * share):02x}" for a, b in ((255, 127), (250, 0), (240, 0)))


def map_of(best) -> str:
    cell, gap, left, top = 26, 34, 92, 46
    width, height = left + 5 * (5 * cell + gap), top + 2 * (5 * cell + 58)
    out = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="12">',
        f'<rect width="{width}" height="{height}" fill="#fff"/>',
        f'<text x="8" y="18">distance [cm] at 125 places: layers from the shoulder forwards, z upwards, y leftwards</text>',
    ]
    for line, condition in enumerate(CONDITIONS):
        distances = [float(row["distance [cm]"]) for row in rows(best[condition], "grid")]
        y0 = top + line * (5 * cell + 58)
        out.append(f'<text x="8" y="{y0 + 70}">{condition}</text><text x="8" y="{y0 + 86}">seed {seed(best[condition])}</text>')
        for layer in range(5):
            x0 = left + layer * (5 * cell + gap)
            out.append(f'<text x="{x0}" y="{y0 - 6}">x {layer + 1}</text>')
            for column in range(5):
                for z in range(5):
                    distance = distances[25 * layer + 5 * column + z]
                    # y grows to the left, z upwards.
                    x, y = x0 + (4 - column) * cell, y0 + (4 - z) * cell
                    ink = "#fff" if distance > 0.6 * WORST else "#333"
                    out.append(f'<rect x="{x}" y="{y}" width="{cell}" height="{cell}" fill="{color(distance)}" stroke="#ccc"/>')
                    text = f"{distance:.1f}" if distance < 9.95 else f"{distance:.0f}"
                    out.append(
                        f'<text x="{x + cell / 2}" y="{y + 17}" text-anchor="middle" font-size="10" fill="{ink}">{text}</text>'
                    )
    return "\n".join([*out, "</svg>", ""])


def main() -> None:
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    root = pathlib.Path(sys.argv[1])
    means, best = {}, {}
    print("| seed | " + " | ".join(f"`{condition}`, mean | greatest" for condition in CONDITIONS) + " |")
    print("|---|---|---|---|---|")
    lines = {}
    for condition in CONDITIONS:
        runs = sorted((run for run in (root / condition).iterdir() if (run / "protocols" / "grid.csv").exists()), key=seed)
        grids = {run: [float(row["distance [cm]"]) for row in rows(run, "grid")] for run in runs}
        means[condition] = [statistics.mean(grid) for grid in grids.values()]
        best[condition] = min(runs, key=lambda run: statistics.mean(grids[run]))
        for run, grid in grids.items():
            lines.setdefault(seed(run), {})[condition] = f"{statistics.mean(grid):.2f} | {max(grid):.1f}"
    for number, cells in sorted(lines.items()):
        print(f"| {number} | " + " | ".join(cells.get(condition, "- | -") for condition in CONDITIONS) + " |")
    print()
    for condition, values in means.items():
        print(f"{condition}: {len(values)} runs, median {statistics.median(values):.2f} cm, {min(values):.2f} to {max(values):.2f} cm")
    u, p = mann_whitney(*(means[condition] for condition in CONDITIONS))
    print(f"Mann-Whitney U = {u:g}, p = {p:.3g}")
    for protocol in ("outside", "target-jump", "locked-torso", "load", "noise", "lesions"):
        print(f"\n{protocol}\n\n| case | " + " | ".join(f"`{condition}`, seed {seed(best[condition])}" for condition in CONDITIONS) + " |")
        print("|---|---|---|")
        found = [by_case(best[condition], protocol) for condition in CONDITIONS]
        if protocol == "outside":
            print("| mean of all | " + " | ".join(f"{statistics.mean(cases.values()):.1f}" for cases in found) + " |")
            continue
        for name in dict.fromkeys(name for cases in found for name in cases):
            print(f"| {name} | " + " | ".join(f"{cases[name]:.1f}" if name in cases else "-" for cases in found) + " |")
    pathlib.Path(sys.argv[2]).write_text(map_of(best))


if __name__ == "__main__":
    main()
