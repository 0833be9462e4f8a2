#!/usr/bin/env python3
"""The continuous networks of benches/network.rs in numpy, one thread, single precision: nanoseconds of a step."""

import os

for library in ("OMP", "OPENBLAS", "MKL"):
    os.environ[f"{library}_NUM_THREADS"] = "1"

import time

import numpy as np

TIME_STEP = np.float32(0.01)

for neurons in (14, 64, 256, 1000):
    generator = np.random.default_rng(1)
    draw = lambda *shape: generator.uniform(-1, 1, shape).astype(np.float32)
    # From neuron j to i at [i, j], so that a row is a target.
    weights, biases, gains = draw(neurons, neurons), draw(neurons), np.ones(neurons, np.float32)
    rates = TIME_STEP / generator.uniform(1, 2, neurons).astype(np.float32)
    inputs, y = draw(64, neurons), np.zeros(neurons, np.float32)
    rounds = []
    steps = 4 if neurons == 1000 else 64
    for _ in range(400):
        begin = time.perf_counter_ns()
        for step in range(steps):
            o = 1 / (1 + np.exp(-gains * (y + biases)))
            y += rates * (weights @ o + inputs[step] - y)
        rounds.append((time.perf_counter_ns() - begin) / steps)
    assert y.dtype == np.float32 and np.isfinite(y).all()
    print(f"ctrnn/euler numpy/{neurons:<20} time: {sorted(rounds)[200]:.0f} ns, least {min(rounds):.0f} ns")
