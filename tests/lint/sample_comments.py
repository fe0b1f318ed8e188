#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Prints random comments for a reader to judge, each with its place and the code below: sample_comments.py [COUNT [SEED]]"""
import random
import re
import sys
from pathlib import Path

import lint

SOURCES = {".cpp", ".h", ".ts", ".mjs"}
CODE_LINES = 3  # number of lines of code shown below each comment


def comments(root):
    """Yields (path, first line, text with the code below) of each comment except licence lines and marks for tools."""
    for path in lint.files(root):
        if path.suffix not in SOURCES or "corpus" in path.parts:
            continue
        lines, at = lint.text(root, path).splitlines(), 0
        while at < len(lines):
            end = at
            while end < len(lines) and re.match(r"\s*(//(?! NOLINT)|/\*(?!\w+=)|\*/|\*$|\* [^{])", lines[end]):
                end += 1
            if end > at:
                block = [line for line in lines[at:end] if "SPDX" not in line]
                if block:
                    yield path, at + 1, "\n".join(block + lines[end : end + CODE_LINES])
            elif re.search(r"\S.*\s//\s(?!namespace|NOLINT)", lines[at]):
                yield path, at + 1, lines[at]
            at = max(end, at + 1)


def main():
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 58
    seed = int(sys.argv[2]) if len(sys.argv) > 2 else random.randrange(10**6)
    found = list(comments(Path(__file__).resolve().parents[2]))
    print(f"{count} of {len(found)} comments, seed {seed}")
    for number, (path, line, text) in enumerate(random.Random(seed).sample(found, count), 1):
        print(f"\n{number}. {path}:{line}\n{text}")


if __name__ == "__main__":
    main()
