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
    before = after = 0
    with subprocess.Popen([*command, f"-max_total_time={seconds}"], stderr=subprocess.PIPE, text=True,
                          errors="replace") as fuzzer:
        for line in fuzzer.stderr:
            print(line, end="", flush=True)
            if reached := re.search(r"\bcov: (\d+)", line):
                after = int(reached[1])
            if "INITED" in line:  # the corpus has been read
                before = after
    if fuzzer.returncode != 0:
        sys.exit(1)
    return before, after


def main(seconds, command):
    if seconds < 1:
        sys.exit("saturate.py: it takes at least a second")
    most = 0  # of any round: an edge that hangs on addresses is reached anew in each
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
