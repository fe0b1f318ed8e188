#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests guest_test.py without a kernel: it must report that the kernel is missing, and deploy/test
must count this as a failure.
"""
import os
import subprocess
import sys
import unittest
from pathlib import Path

HERE = Path(__file__).resolve().parent
DEPLOY_TEST = HERE.parents[2] / "deploy/test"
SKIPPED, FAILED = 77, 1


def run_without_kernel(**variables):
    """Returns the exit code and the output."""
    environment = {name: value for name, value in os.environ.items() if name != "VITRINE_NO_SKIPS"}
    ended = subprocess.run([sys.executable, HERE / "guest_test.py", "/absent", "/absent", "/absent"], text=True,
                           capture_output=True, env=environment | variables, check=False)
    return ended.returncode, ended.stdout


class LeftOut(unittest.TestCase):
    def test_is_skipped_with_a_reason(self):
        code, said = run_without_kernel()
        self.assertEqual(code, SKIPPED)
        self.assertRegex(said, r"^left out: there is no .+; run deploy/setup test\n$")

    def test_is_a_failure_where_everything_is_installed(self):
        self.assertEqual(run_without_kernel(VITRINE_NO_SKIPS="1")[0], FAILED)
        self.assertIn("export VITRINE_NO_SKIPS=1\n", DEPLOY_TEST.read_text(encoding="utf-8"))


if __name__ == "__main__":
    unittest.main()
