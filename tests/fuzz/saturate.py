#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Fuzzes in rounds until one reaches nothing new, or for SECONDS: saturate.py SECONDS FUZZER [ARGUMENT...]

Fails with the fuzzer."""
import re
import subprocess
import sys

ROUND = 300  # seconds


def fuzz(seconds, command):
    """Runs one round and shows what it says. Returns the edges reached before and after."""
    edges = []
    with subprocess.Popen([*command, f"-max_total_time={seconds}"], stderr=subprocess.PIPE, text=True,
                          errors="replace") as fuzzer:
        for line in fuzzer.stderr:
            print(line, end="", flush=True)
            if reached := re.search(r"\bcov: (\d+)", line):
                edges.append(int(reached[1]))
    if fuzzer.returncode != 0:
        sys.exit(1)
    return edges[0], edges[-1]


def main(seconds, command):
    for start in range(0, seconds, ROUND):
        before, after = fuzz(min(ROUND, seconds - start), command)
        if after == before:
            print(f"saturated: {after} edges, none of them new in the last round")
            return
    print(f"not saturated: {after - before} of {after} edges are new in the last round")


main(int(sys.argv[1]), sys.argv[2:])
