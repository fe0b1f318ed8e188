#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that the systemd unit of the daemon is valid, confines it, and bounds its memory and its threads."""
import configparser
import os
import re
import shutil
import subprocess
import unittest
from pathlib import Path

UNIT = Path(__file__).resolve().parents[2] / "deploy" / "vitrined.service"
MOST_EXPOSURE = 1.5  # largest allowed exposure; systemd-analyze rates it from 0 to 10


def service():
    """Returns the settings of the section `[Service]`; the last of repeated ones counts."""
    unit = configparser.ConfigParser(strict=False, interpolation=None)
    unit.optionxform = str
    unit.read(UNIT)
    return unit["Service"]


class Unit(unittest.TestCase):
    @unittest.skipUnless(shutil.which("systemd-analyze") or "VITRINE_NO_SKIPS" in os.environ, "systemd-analyze is not installed")
    def test_it_exposes_little(self):
        done = subprocess.run(["systemd-analyze", "security", "--offline=true", f"--threshold={MOST_EXPOSURE * 10:.0f}", "--no-pager", UNIT],
                              text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        exposure = re.search(r"Overall exposure level for vitrined.service: ([0-9.]+)", done.stdout)
        self.assertIsNotNone(exposure, done.stdout)
        self.assertLessEqual(float(exposure[1]), MOST_EXPOSURE, done.stdout)
        self.assertEqual(done.returncode, 0, done.stdout)

    def test_processes_that_read_uploads_may_not_leave_the_network_but_restrict_themselves(self):
        # Without namespaces of their own, only a seccomp filter confines these processes. tests/server/sandbox tests that they
        # then work and have no network.
        self.assertEqual(service()["RestrictNamespaces"], "yes")
        self.assertIn("seccomp", UNIT.read_text(encoding="utf-8").split("SystemCallFilter=")[1].splitlines()[0])

    def test_it_bounds_memory_and_threads(self):
        self.assertRegex(service()["MemoryMax"], r"^[1-9][0-9]?%$")
        per_core = 4  # threads for connections, requests and computations, and one of a build
        waiting = 128  # threads that wait for disks, devices and other daemons, and of libraries
        self.assertGreaterEqual(int(service()["TasksMax"]), 256 * per_core + waiting)

    def test_a_build_that_is_killed_for_its_memory_does_not_stop_the_daemon(self):
        self.assertEqual(service()["OOMPolicy"], "continue")


if __name__ == "__main__":
    unittest.main()
