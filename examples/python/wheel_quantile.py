"""The wheel that one of a thousand exceeds: blade stiffnesses of a bladed disk with a ring damper scatter by 1 %.

    PYTHONPATH=include python examples/python/wheel_quantile.py [--wheels 10000] [--fine] [--all FILE] [--draws 500]

Some hundred of 10,000 wheels are solved, in half a minute of processor time; --fine corrects the three harmonics on four of them to a
tolerance of 1 %, in eight minutes. --all solves every wheel, in a quarter of an hour, keeps the results in FILE (.npy) and compares:
the interval against the order of all wheels, and how often the intervals of samples of 1,000 wheels have the quantile of all.
"""
import argparse
import math
import os
import time
from typing import Any, Dict

import numpy as np

import hbvib
from ring_damper import ring_damper

HZ = 2 * math.pi
SPAN = (HZ * 208.5, HZ * 211.5)
CHUNK = 500  # wheels solved at a time
OPTIONS: Dict[str, Any] = dict(dofs=[0], harmonics=3, tolerance=0)


def every_wheel(sector: hbvib.Model, patterns: Any, path: str) -> hbvib.WheelStudy:
    """All wheels, those of an earlier run from the file."""
    rows = np.load(path) if os.path.exists(path) else np.empty((0, 5))
    tuned = sector.wheel_study(SPAN, patterns[:1], **OPTIONS).tuned
    while len(rows) < len(patterns):
        part = sector.wheel_study(SPAN, patterns[len(rows):len(rows) + CHUNK], **OPTIONS)
        rows = np.vstack([rows, np.column_stack([part.largest, part.blade, part.omega, part.status, part.predicted])])
        np.save(path, rows)
        print(f"{len(rows)} wheels", flush=True)
    largest, blade, omega, status, predicted = rows[:len(patterns)].T
    return hbvib.WheelStudy(largest, blade, omega, status, tuned, predicted)


def coverage(study: hbvib.WheelStudy, probability: float, draws: int) -> "tuple[float, float]":
    """Share of the intervals of 95 % of samples of 1,000 wheels that have the quantile of all, and how many wheels they solve."""
    from hbvib._order_statistics import screened  # its wheels are solved already
    wanted = float(np.quantile(study.largest, probability))
    inside, solved = 0, 0
    for draw in range(draws):
        random = np.random.default_rng(draw)
        at = random.choice(len(study), 1000, replace=False)
        largest = study.largest[at]
        found = screened(study.predicted[at], largest.take, probability, 0.05, 60, 600, random)
        inside += found.lower <= wanted <= found.upper
        solved += int(np.isfinite(found.known).sum())
    return inside / draws, solved / draws


def main() -> None:
    parser = argparse.ArgumentParser(description="The wheel that one of a thousand exceeds.")
    parser.add_argument("--wheels", type=int, default=10_000)
    parser.add_argument("--draws", type=int, default=500)
    parser.add_argument("--fine", action="store_true")
    parser.add_argument("--all", metavar="FILE")
    given = parser.parse_args()
    sector = ring_damper(1.0)
    patterns = 0.01 * np.random.default_rng(49).standard_normal((given.wheels, 24))
    begin = time.process_time()
    fine: Any = dict(tolerance=1e-2) if given.fine else None
    found = sector.wheel_quantile(SPAN, 0.999, patterns, fine=fine, corrected=4, **OPTIONS)
    print(f"{found} in {time.process_time() - begin:.0f} s")
    print(f"three harmonics: {found.coarse.value:.4f}, {found.coarse.lower:.4f} to {found.coarse.upper:.4f}; predictions correlate by "
          f"{found.correlation:.4f}; mean {found.mean:.5f} +- {found.mean_error:.5f}, worth {found.gain:.0f} times as many wheels")
    if given.all:
        study = every_wheel(sector, patterns, given.all)
        alone = study.quantile(0.999)
        print(f"all wheels: {alone.value:.4f}, {alone.lower:.4f} to {alone.upper:.4f}; mean {study.amplification.mean():.5f}")
        for probability in (0.9, 0.99):
            share, solved = coverage(study, probability, given.draws)
            print(f"quantile {probability}: {100 * share:.1f} % of {given.draws} intervals of 95 % have it; {solved:.0f} of 1000 wheels solved")


if __name__ == "__main__":
    main()
