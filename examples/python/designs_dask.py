"""A study of many designs on the workers of Dask: peak amplitude of the bladed disk with a ring damper against normal load,
contact stiffness and ring mass.

    pip install distributed
    PYTHONPATH=include python examples/python/designs_dask.py [--designs 1000] [--workers 2] [--csv FILE]

--scheduler ADDRESS uses the workers of a running scheduler instead of local processes; hbvib must be installed on their
machines. --kill ends one worker in the middle: only the designs that it had are done again.
"""
import argparse
import math
import os
import signal
import sys
from typing import Any

import distributed
import numpy as np

import hbvib
from ring_damper import ring_damper

dask: Any = distributed  # has no types of its own
HZ = 2 * math.pi
CHUNK = 8  # designs sent at a time


def designs(count: int) -> Any:
    """Stiffness in N/m, normal load in N, and mass added to a ring of 30 g in kg, at random but always the same."""
    random = np.random.default_rng(20)
    limit = 0.02 * 2500 ** random.random(count)
    return np.column_stack([random.uniform(2e7, 1e8, count), limit / 0.3, random.uniform(-0.025, 0.022, count)])


def parameters() -> "list[hbvib.Parameter]":
    ring = np.diag([0, 0, 0, 1.0])
    return [hbvib.Parameter("kt", contact=0), hbvib.Parameter("preload", contact=0), hbvib.Parameter("mass", direction=ring)]


def solve(model: hbvib.Model, values: Any) -> hbvib.Batch:
    """Runs on a worker: the model has come to it once, as bytes."""
    return model.batch((HZ * 205, HZ * 213), parameters(), values, harmonics=9, response_dof=0)


def study(client: Any, count: int, kill: bool = False) -> "tuple[Any, hbvib.Batch]":
    values = designs(count)
    chunks = [values[i:i + CHUNK] for i in range(0, count, CHUNK)]
    model = client.scatter(ring_damper(5), broadcast=True)
    futures = client.map(solve, [model] * len(chunks), chunks, pure=False)
    if kill:
        done = 0
        for _ in dask.as_completed(futures):
            done += 1
            if done >= len(chunks) // 4:
                break
        lost = sorted(client.run(os.getpid).values())[0]
        os.kill(lost, signal.SIGKILL)  # a worker of this machine
        print(f"killed a worker after {done} of {len(chunks)} chunks", file=sys.stderr)
    dask.wait(futures)
    return values, hbvib.Batch.concatenate(client.gather(futures))


def main() -> None:
    parser = argparse.ArgumentParser(description="A study of many designs on the workers of Dask.")
    parser.add_argument("--designs", type=int, default=1000)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--scheduler", help="address of a running scheduler")
    parser.add_argument("--kill", action="store_true", help="end one worker in the middle")
    parser.add_argument("--csv", help="file for all peaks")
    given = parser.parse_args()
    cluster = given.scheduler or dask.LocalCluster(n_workers=given.workers, threads_per_worker=1, dashboard_address=None)
    with dask.Client(cluster) as client:
        values, batch = study(client, given.designs, given.kill)
    best = np.nanargmin(batch.peak_amplitude)
    kt, preload, mass = values[best]
    print(f"{len(batch)} designs, {np.count_nonzero(batch.status)} without a result")
    print(f"lowest peak {batch.peak_amplitude[best]:.9e} m at {batch.peak_omega[best] / HZ:.6f} Hz:"
          f" kt {kt:.4e} N/m, N0 {preload:.3f} N, ring {1e3 * (0.03 + mass):.2f} g")
    if given.csv:
        table = np.column_stack([values, batch.peak_omega, batch.peak_amplitude, batch.status])
        np.savetxt(given.csv, table, fmt="%.17g", delimiter=",", header="kt,preload,ring_mass,omega,amplitude,status", comments="")


if __name__ == "__main__":
    main()
