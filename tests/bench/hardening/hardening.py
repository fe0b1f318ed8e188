#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures what the protections against memory faults cost (VITRINE_HARDENED in codec/cmake/modules.cmake).

Usage: hardening.py [ROUNDS [MESH]]

Compares the release build, which `cmake --workflow --preset release` makes with the protections, with a build without them,
which this script makes in build/unhardened. Runs both alternately, ROUNDS times (5). Prints the medians of three figures and their
ratios:
  decode      processor time for decoding the model of MESH (the larger scan that ships) on one thread
  processor   processor time of the daemon for a chunk, relative to that of nginx in the same run
  throughput  chunks per second of the daemon, relative to nginx in the same run

The exit code is 0 only if decoding is at most 2 % slower with the protections. The figures of the daemon differ by more than that
from run to run, so they are not judged.
"""
import json
import statistics
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
FOLDERS = {"on": ROOT / "build/release", "off": ROOT / "build/unhardened"}
MEASURED = ("vitrined", "bench-decode", "bench-server")  # the programs that both builds need
FIGURES = {"decode": False, "processor": False, "throughput": True}  # whether more is better
MOST = 1.02  # largest allowed ratio of the times for decoding


def output(*words, may_fail=False):
    return subprocess.run(words, cwd=ROOT, stdout=subprocess.PIPE, text=True, check=not may_fail).stdout


def make_programs():
    missing = [name for name in ("vitrine", *MEASURED) if not (FOLDERS["on"] / "bin" / name).exists()]
    if missing:
        sys.exit(f"hardening.py: build/release/bin has no {missing[0]}; run 'cmake --workflow --preset release' first")
    output("cmake", "--preset", "release", "-B", FOLDERS["off"], "-DVITRINE_WEB=OFF", "-DVITRINE_HARDENED=OFF")
    subprocess.run(["ninja", "-C", FOLDERS["off"], *MEASURED], check=True)


def decode_time(folder, model):
    return float(output(folder / "bin/bench-decode", model))


def served(folder):
    """Returns the daemon's processor time for a chunk and its chunks per second, both relative to nginx."""
    # The benchmark fails if a figure misses its own limit, which is not judged here.
    figures = json.loads(output(folder / "bin/bench-server", "--json", "throughput", may_fail=True))
    return figures["chunk_get_processor"]["ratio_to_nginx"], figures["chunk_get"]["ratio_to_nginx"]


def measure(rounds, model):
    """Returns, for all figures and both builds, the list of measured values."""
    values = {figure: {build: [] for build in FOLDERS} for figure in FIGURES}
    for number in range(rounds):
        order = list(FOLDERS.items())
        for build, folder in order if number % 2 == 0 else reversed(order):
            for figure, value in zip(FIGURES, (decode_time(folder, model), *served(folder))):
                values[figure][build].append(value)
    return values


def cost(values, more_is_better):
    """Returns the ratio of the medians; above 1 if the protections make the figure worse."""
    on, off = statistics.median(values["on"]), statistics.median(values["off"])
    return on, off, off / on if more_is_better else on / off


def main():
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 5
    mesh = Path(sys.argv[2]).resolve() if len(sys.argv) > 2 else ROOT / "tests/models/skull.obj"
    make_programs()
    model = FOLDERS["off"] / "model.pmesh"
    output(FOLDERS["on"] / "bin/vitrine", "build", mesh, "-o", model, "--force")
    values = measure(rounds, model)
    print(f"{'':12}{'with':>12}{'without':>12}{'ratio':>9}   limit of decode: {MOST}")
    ratios = {}
    for figure, more_is_better in FIGURES.items():
        on, off, ratio = cost(values[figure], more_is_better)
        ratios[figure] = ratio
        print(f"{figure:12}{on:12.5f}{off:12.5f}{ratio:9.3f}")
    return 0 if ratios["decode"] <= MOST else 1


if __name__ == "__main__":
    sys.exit(main())
