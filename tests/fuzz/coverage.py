#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""coverage.py PROFDATA COV BUILD: prints the share of the decoder's and readers' lines that the fuzzers' corpora reach.

Replays the committed corpora through the programs of the preset `coverage`. Fails below 95 % of the
decoder's lines."""
import json
import os
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
CORPUS = ROOT / "tests/fuzz/corpus"
# minimum share of the decoder's lines that the corpora must reach, in per cent
LEAST_OF_DECODER = 95
DECODER = r"codec/(?:base|format|coding|refine|plan)/\w+"


def decoder_sources(lines):
    """Returns the sources of the decoder with the headers that they include. These are the sources that the browser
    compiles, and connectivity. Omits codec/core, which the encoder shares."""
    listed = set(re.findall(DECODER + r"\.cpp", (ROOT / "codec/wasm/CMakeLists.txt").read_text()))
    listed |= {"codec/mesh/connectivity.cpp", "codec/build/refine.cpp"}
    return set(lines) & with_headers(listed)


def with_headers(sources):
    """Returns the sources, and the decoder's headers that they include directly or indirectly."""
    found, ahead = set(sources), list(sources)
    while ahead:
        included = set(re.findall(r'#include "(' + DECODER + r'\.h)"', (ROOT / ahead.pop()).read_text()))
        ahead += included - found
        found |= included
    return found


def replay(program, profile):
    subprocess.run([program, CORPUS / program.name.removeprefix("fuzz_")], check=True, stdout=subprocess.DEVNULL,
                   env={**os.environ, "LLVM_PROFILE_FILE": str(profile)})
    return profile


def count_lines(cov, profile, programs):
    """Returns {source: (number of lines reached, number of lines)} for all sources of the codec."""
    objects = [word for program in programs[1:] for word in ("-object", program)]
    report = subprocess.run([cov, "export", "-summary-only", "-instr-profile", profile, programs[0], *objects],
                            check=True, capture_output=True, text=True).stdout
    lines = {}
    for file in json.loads(report)["data"][0]["files"]:
        path = Path(re.sub(r".*/modules/\w+/", f"{ROOT}/", file["filename"])).resolve()
        if path.is_relative_to(ROOT / "codec"):
            summary = file["summary"]["lines"]
            lines[str(path.relative_to(ROOT))] = (summary["covered"], summary["count"])
    return lines


def show(name, counts):
    reached, lines = map(sum, zip(*counts))
    print(f"{name:<42} {reached:>6} of {lines:>6} lines {100 * reached / lines:>7.2f} %")
    return 100 * reached / lines


def main():
    profdata, cov, build = sys.argv[1:]
    programs = sorted(Path(build, "fuzz").glob("fuzz_*"))
    profiles = [replay(program, Path(build, "fuzz", f"profile.{i}")) for i, program in enumerate(programs)]
    merged = Path(build, "fuzz/profile")
    subprocess.run([profdata, "merge", "-o", merged, *profiles], check=True)
    lines = count_lines(cov, merged, programs)
    decoder, readers = decoder_sources(lines), {source for source in lines if source.startswith(("codec/gltf/", "codec/import/", "codec/package/", "codec/picture/"))}
    for source in sorted(decoder | readers):
        show(source, [lines[source]])
    print()
    for folder in sorted({str(Path(source).parent) for source in decoder | readers}):
        show(folder, [lines[source] for source in decoder | readers if str(Path(source).parent) == folder])
    print()
    show("readers", [lines[source] for source in readers])
    share = show("decoder", [lines[source] for source in decoder])
    if share < LEAST_OF_DECODER:
        sys.exit(f"coverage: under {LEAST_OF_DECODER} % of the decoder; fuzz longer, merge what is found into "
                 "tests/fuzz/corpus, or delete what nothing reaches")


if __name__ == "__main__":
    main()
