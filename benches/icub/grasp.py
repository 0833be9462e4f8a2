"""Tables and the map of docs/results/icub.md from finished runs of `icub-reach-grasp` that were tested by its protocols.

    for p in areas noise lesions; do farsa test RUN --protocol $p --trials 100; done
    python benches/icub/grasp.py RUNS MAP.svg > tables.md

RUNS holds the runs of `farsa run icub-reach-grasp --replications`. Python 3.11, standard library alone.
"""

import pathlib
import statistics
import sys
import tomllib

from reach import case_name, rows, seed

PARTS = 4


def cases(run: pathlib.Path, protocol: str):
    """Share of successes [%] and mean fitness of each case, in order, by name."""
    found = {}
    for row in rows(run, protocol):
        found.setdefault(case_name(row), []).append((row["success"] == "true", float(row["fitness"])))
    return {
        name: (100 * statistics.mean(success for success, _ in trials), statistics.mean(fitness for _, fitness in trials))
        for name, trials in found.items()
    }


def color(share: float) -> str:
    return "#" + "".join(f"{round(a + (b - a) * share / 100):02x}" for a, b in ((255, 20), (255, 120), (255, 60)))


def map_of(runs) -> str:
    cell, gap, top = 34, 26, 48
    width, height = 16 + len(runs) * (PARTS * cell + gap), top + PARTS * cell + 28
    out = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="12">',
        f'<rect width="{width}" height="{height}" fill="#fff"/>',
        '<text x="8" y="18">successes [%] in 16 parts of the table: forwards upwards, left to the left; the frame is the area of training</text>',
    ]
    for number, run in enumerate(runs):
        x0 = 8 + number * (PARTS * cell + gap)
        out.append(f'<text x="{x0}" y="{top - 8}">seed {seed(run)}</text>')
        for index, (share, _) in enumerate(cases(run, "areas").values()):
            forwards, leftwards = divmod(index, PARTS)
            x, y = x0 + (PARTS - 1 - leftwards) * cell, top + (PARTS - 1 - forwards) * cell
            ink = "#fff" if share > 60 else "#333"
            out.append(f'<rect x="{x}" y="{y}" width="{cell}" height="{cell}" fill="{color(share)}" stroke="#ccc"/>')
            out.append(f'<text x="{x + cell / 2}" y="{y + 21}" text-anchor="middle" font-size="11" fill="{ink}">{share:.0f}</text>')
        area = tomllib.loads((run / "config.toml").read_text())["area"]
        trained, tested = area["size"][0], area["tested"][0]
        side = PARTS * cell * trained / tested
        at = (PARTS * cell - side) / 2
        out.append(f'<rect x="{x0 + at}" y="{top + at}" width="{side}" height="{side}" fill="none" stroke="#c33" stroke-width="2"/>')
    return "\n".join([*out, "</svg>", ""])


def main() -> None:
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    runs = sorted((run for run in pathlib.Path(sys.argv[1]).iterdir() if (run / "protocols" / "areas.csv").exists()), key=seed)
    own = {run: next(iter(cases(run, "noise").values())) for run in runs}
    areas = {run: [share for share, _ in cases(run, "areas").values()] for run in runs}
    print("| seed | success in its own area [%] | fitness there | success in all 16 parts [%] | parts with a quarter and more |")
    print("|---|---|---|---|---|")
    for run in runs:
        share, fitness = own[run]
        print(f"| {seed(run)} | {share:.0f} | {fitness:.2f} | {statistics.mean(areas[run]):.0f} | {sum(one >= 25 for one in areas[run])} |")
    best = max(runs, key=lambda run: own[run])
    for protocol in ("noise", "lesions"):
        print(f"\n{protocol}\n\n| case | success of seed {seed(best)} [%] | fitness |")
        print("|---|---|---|")
        for name, (share, fitness) in cases(best, protocol).items():
            print(f"| {name} | {share:.0f} | {fitness:.2f} |")
    pathlib.Path(sys.argv[2]).write_text(map_of(runs))


if __name__ == "__main__":
    main()
