#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""saturate.py SECONDS FUZZER [ARGUMENT...]: fuzzes in rounds until a round adds no coverage, for SECONDS at most.

Fails if the fuzzer fails."""
import re
import subprocess
import sys

ROUND = 300  # duration of a round, in seconds


def fuzz(seconds, command):
    """Runs one round and prints its output. Returns the number of edges reached before and after."""
    before = after = 0
    with subprocess.Popen([*command, f"-max_total_time={seconds}"], stderr=subprocess.PIPE, text=True,
                          errors="replace") as fuzzer:
        for line in fuzzer.stderr:
            print(line, end="", flush=True)
            if reached := re.search(r"\bcov: (\d+)", line):
                after = int(reached[1])
            if "INITED" in line:  # the fuzzer has read the corpus
                before = after
    if fuzzer.returncode != 0:
        sys.exit(1)
    return before, after


def main(seconds, command):
    if seconds < 1:
        sys.exit("saturate.py: it takes at least a second")
    # the most edges that a round has reached; memory addresses differ in each round and affect a few edges
    most = 0
    for start in range(0, seconds, ROUND):
        length = min(ROUND, seconds - start)
        before, after = fuzz(length, command)
        most = max(most, before)
        if after <= most and length == ROUND:
            print(f"saturated: {after} edges, no more than before the last round")
            return
        new, most = max(0, after - most), max(most, after)
    print(f"{new} of {after} edges are new in the last {length} s")


main(int(sys.argv[1]), sys.argv[2:])
