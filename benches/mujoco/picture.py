#!/usr/bin/env python3
"""Draws the cost against the error of both engines' steps from docs/results/speed-errors.csv.

    picture.py ERRORS.csv PICTURE.svg"""

import csv
import math
import sys
from pathlib import Path

LOOKS = {  # colour, shape of the points
    "FARSA, one world": ("#1b6ca8", "circle"),
    "FARSA, 8 lanes AVX2": ("#2a9d5c", "square"),
    "FARSA, 16 lanes AVX-512": ("#8a5cb8", "triangle"),
    "MuJoCo": ("#c8502d", "diamond"),
}
TITLES = {"free": "free motion", "waves": "quick motion (waves)", "table": "hand on the table"}
EQUAL = 0.5
ERRORS, COSTS = (0.001, 1.0), (0.2, 500.0)
LEFT, TOP, WIDTH, HEIGHT, GAP = 62, 74, 250, 300, 36


def read(text):
    """For each phase and engine its steps: (step, error [deg], cost [us per 10 ms])."""
    found = {}
    for phase, engine, step, error, cost in list(csv.reader(text.splitlines()))[1:]:
        found.setdefault((phase, engine), []).append((step, float(error), float(cost)))
    return found


def along(value, bounds, size):
    low, high = map(math.log, bounds)
    return (math.log(value) - low) / (high - low) * size


def point(shape, x, y, colour):
    r = 4
    if shape == "circle":
        return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{r}" fill="{colour}"/>'
    corners = {
        "square": [(-r, -r), (r, -r), (r, r), (-r, r)],
        "triangle": [(0, -r - 1), (r + 1, r), (-r - 1, r)],
        "diamond": [(0, -r - 1), (r + 1, 0), (0, r + 1), (-r - 1, 0)],
    }[shape]
    path = " ".join(f"{x + dx:.1f},{y + dy:.1f}" for dx, dy in corners)
    return f'<polygon points="{path}" fill="{colour}"/>'


def text(x, y, words, anchor="middle", more=""):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}"{more}>{words}</text>'


def line(x1, y1, x2, y2, more):
    return f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" {more}/>'


def decades(bounds):
    first, last = math.ceil(math.log10(bounds[0]) - 1e-9), math.floor(math.log10(bounds[1]) + 1e-9)
    return [10.0**k for k in range(first, last + 1)]


def panel(found, phase, left):
    bottom = TOP + HEIGHT
    place = lambda error, cost: (left + along(error, ERRORS, WIDTH), bottom - along(cost, COSTS, HEIGHT))
    out = [f'<rect x="{left}" y="{TOP}" width="{WIDTH}" height="{HEIGHT}" fill="none" stroke="#888"/>']
    out.append(text(left + WIDTH / 2, TOP - 8, TITLES[phase], more=' font-weight="bold"'))
    for error in decades(ERRORS):
        x, _ = place(error, COSTS[0])
        out += [line(x, TOP, x, bottom, 'stroke="#ddd"'), text(x, bottom + 16, f"{error:g}")]
    for cost in decades(COSTS):
        _, y = place(ERRORS[0], cost)
        out.append(line(left, y, left + WIDTH, y, 'stroke="#ddd"'))
        if left == LEFT:
            out.append(text(left - 6, y + 4, f"{cost:g}", "end"))
    x, _ = place(EQUAL, COSTS[0])
    out.append(line(x, TOP, x, bottom, 'stroke="#555" stroke-dasharray="4 3"'))
    for engine, (colour, shape) in LOOKS.items():
        if (phase, engine) not in found:
            continue
        places = [(step, *place(error, cost)) for step, error, cost in found[phase, engine]]
        path = " ".join(f"{x:.1f},{y:.1f}" for _, x, y in places)
        out.append(f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="1.5"/>')
        for step, x, y in places:
            out.append(point(shape, x, y, colour))
            if engine == "MuJoCo":
                # Below on the left for one, which else would lie on its neighbour's.
                at = (x - 6, y + 12, step, "end") if step == "2.5" else (x + 7, y - 5, step, "start")
                out.append(text(*at, ' font-size="10" fill="#555"'))
    return out


def main():
    source, target = map(Path, sys.argv[1:3])
    found = read(source.read_text())
    phases = [phase for phase in TITLES if (phase, "MuJoCo") in found]
    width = LEFT + len(phases) * (WIDTH + GAP)
    height = TOP + HEIGHT + 48
    out = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}"'
        ' font-family="sans-serif" font-size="12">',
        "<title>Cost against error of FARSA's and MuJoCo's steps</title>",
        f'<rect width="{width}" height="{height}" fill="white"/>',
    ]
    x = LEFT
    for engine, (colour, shape) in LOOKS.items():
        out += [point(shape, x + 5, 20, colour), text(x + 16, 24, engine, "start")]
        x += 40 + 7 * len(engine)
    out.append(text(width - GAP, 24, "dashed: 0.5 degrees", "end", ' fill="#555"'))
    steps = "points: steps of 10, 5, 2.5, 2 and 1 ms from the lowest up, named at MuJoCo's"
    out.append(text(LEFT, 44, steps, "start", ' fill="#555"'))
    for number, phase in enumerate(phases):
        out += panel(found, phase, LEFT + number * (WIDTH + GAP))
    out.append(text(LEFT + (width - LEFT - GAP) / 2, height - 10, "RMS error of J1 to J7 [deg]"))
    middle = TOP + HEIGHT / 2
    turned = f' transform="rotate(-90 18 {middle})"'
    out.append(text(18, middle, "microseconds per world and 10 ms", more=turned))
    target.write_text("\n".join([*out, "</svg>", ""]))


if __name__ == "__main__":
    main()
