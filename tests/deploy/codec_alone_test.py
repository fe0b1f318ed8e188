#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the codec on a Debian with only the packages that it needs: it builds, passes its tests, can be installed,
and another project can use it.

Environment: VITRINE_CODEC_ROOT, the root folder of that Debian, which deploy/setup makes."""
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

# This script runs in its own mount and network namespaces, so it changes nothing in the root folder
# and downloads nothing.
BUILD = r"""set -euo pipefail
mount -t tmpfs -o size=6g none "$STATE"
mkdir "$STATE/upper" "$STATE/work" "$STATE/root"
mount -t overlay none -o "lowerdir=$BARE,upperdir=$STATE/upper,workdir=$STATE/work" "$STATE/root"
mount --bind /proc "$STATE/root/proc"
mount --bind /dev "$STATE/root/dev"
mkdir "$STATE/root/vitrine"
git -c safe.directory='*' -C "$SOURCE" ls-files -zco --exclude-standard |
  tar -C "$SOURCE" --null --no-recursion --ignore-failed-read -T - -c | tar -C "$STATE/root/vitrine" -x
echo "$PROJECT" >"$STATE/root/CMakeLists.txt"
exec env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 chroot "$STATE/root" bash -euo pipefail -c "$INSIDE"
"""

# Compiles with little optimisation, because that is faster. Leaves out the tests with random
# meshes, which the release build runs.
INSIDE = r"""
cd /vitrine
cmake --preset codec -DCMAKE_CXX_FLAGS_RELWITHDEBINFO="-O1 -g0"
cmake --build --preset codec
ctest --preset codec -E ^property
cmake --install build/codec
cmake -G Ninja -S / -B /example
cmake --build /example
/example/example /vitrine/tests/models/demosthenes.obj /coarse.glb
head -c 4 /coarse.glb
"""

PROJECT = """cmake_minimum_required(VERSION 3.25)
project(example CXX)
find_package(vitrine 0.1 REQUIRED)
add_executable(example /vitrine/tests/codec/build/example.cpp)
target_link_libraries(example PRIVATE vitrine::codec)
"""


class CodecAlone(unittest.TestCase):
    def test_its_page_shows_the_example(self):
        example = (ROOT / "tests/codec/build/example.cpp").read_text(encoding="utf-8")
        self.assertIn(example.split("\n", 1)[1], (ROOT / "codec/README.md").read_text(encoding="utf-8"))

    def test_it_is_built_tested_installed_and_found(self):
        bare = Path(os.environ["VITRINE_CODEC_ROOT"])
        self.assertTrue(bare.is_dir(), f"{bare} is missing: run ./deploy/setup full")
        with tempfile.TemporaryDirectory() as state:
            result = subprocess.run(
                ["unshare", "--mount", "--net", "bash", "-c", BUILD], stdin=subprocess.DEVNULL, capture_output=True, text=True,
                errors="replace",
                env={**os.environ, "STATE": state, "BARE": str(bare), "SOURCE": str(ROOT), "PROJECT": PROJECT, "INSIDE": INSIDE})
        self.assertEqual(result.returncode, 0, result.stdout[-4000:] + result.stderr[-4000:])
        self.assertIn("100% tests passed", result.stdout)
        self.assertRegex(result.stdout, r"\n(9\d\d|1000) triangles\nglTF$")


if __name__ == "__main__":
    unittest.main()
