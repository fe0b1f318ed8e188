#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that the Debian package installs, creates its user, and runs its confined service under a real systemd.

Environment: VITRINE_BUILD, the folder of the build whose programs are packed."""
import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

from hardening_test import PROGRAMS, faults_of

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ["VITRINE_BUILD"])
MESH = ROOT / "tests" / "models" / "demosthenes.obj"

# Boots a copy of this machine's file system in new mount, PID and network namespaces. Its systemd starts the unit
# `trial`, whose script installs and tests the package. The system ends when the script ends.
MACHINE = """set -euo pipefail
mount -t tmpfs none "$STATE"
mkdir "$STATE/upper" "$STATE/work" "$STATE/root"
mount -t overlay none -o "lowerdir=/,upperdir=$STATE/upper,workdir=$STATE/work" "$STATE/root"
cd "$STATE/root"
rm -f usr/sbin/policy-rc.d  # images of containers have one that starts no service
cp "$PACKAGE" root/vitrine.deb
install --mode=0644 "$MESH" var/tmp/bust.obj
echo "$SCRIPT" >root/script
echo "$UNIT" >etc/systemd/system/trial.service
systemd-nspawn --quiet --register=no --keep-unit --private-network --directory=. --boot systemd.unit=trial.service </dev/null || true
cat root/said
"""

UNIT = """[Unit]
Wants=basic.target
After=basic.target
SuccessAction=poweroff-force
FailureAction=poweroff-force
[Service]
Type=oneshot
ExecStart=bash -euo pipefail /root/script
StandardOutput=file:/root/said
StandardError=file:/root/said
"""

TRIAL = r"""
ip link set lo up
dpkg --install /root/vitrine.deb
id vitrine
systemd-analyze verify vitrined.service
systemctl is-enabled vitrined
as_user() { runuser --user vitrine -- "$@"; }
as_user vitrined --config=/etc/vitrine.conf --check-config
token=$(as_user vitrine token create --role operator --data /var/lib/vitrine --json | jq -r .token)
url=$(vitrine publish /var/tmp/bust.obj --server http://127.0.0.1:8080 --token "$token" --json | jq -r .url)
head() { curl -fsS -o /root/head "${url/models/api\/v1\/models}/head"; }
head
systemctl reload vitrined
until test -s /var/log/vitrine/access.log; do head; done
logrotate --force /etc/logrotate.d/vitrine
test -s /var/log/vitrine/access.log.1
stat -c '%U %a %n' /var/lib/vitrine /var/log/vitrine /var/log/vitrine/access.log.1
grep -E '^(Uid|CapEff|NoNewPrivs)' "/proc/$(systemctl show --property=MainPID --value vitrined)/status"
systemctl restart vitrined
head
journalctl --unit vitrined --output cat
dpkg --purge vitrine
! systemctl is-active vitrined
test -s /var/lib/vitrine/catalogue.sqlite
test ! -e /etc/vitrine.conf
test ! -e /var/log/vitrine
echo passed
"""


def run(*words, **more):
    done = subprocess.run(words, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, **more)
    if done.returncode != 0:
        raise AssertionError(f"{words[0]} ended with {done.returncode}:\n{done.stdout}")
    return done.stdout


class Package(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        run("cpack", "--config", BUILD / "CPackConfig.cmake", "-B", cls.folder)
        cls.package, = cls.folder.glob("*.deb")
        run("dpkg-deb", "--extract", cls.package, cls.folder / "files")

    def test_it_has_what_serves_and_scans(self):
        content = run("dpkg-deb", "--contents", self.package)
        for path in ["usr/bin/vitrine", "usr/bin/vitrined", "usr/bin/vitrine-guardian", "lib/systemd/system/vitrined.service",
                     "lib/udev/rules.d/60-vitrine.rules", "usr/lib/sysusers.d/vitrine.conf", "etc/vitrine.conf",
                     "usr/share/man/man8/vitrined.8.gz", "usr/share/man/man1/vitrine.1.gz"]:
            self.assertIn(f" ./{path}\n", content)
        self.assertNotIn("vitrine-rig", content)
        for line in content.splitlines():
            self.assertIn(" root/root ", line)

    def test_it_says_what_it_needs_and_which_files_are_the_administrators(self):
        fields = run("dpkg-deb", "--field", self.package)
        for library in ["libsqlite3-0", "libssl3", "libaravis-0.8-0"]:
            self.assertIn(library, fields)
        conffiles = run("dpkg-deb", "--info", self.package, "conffiles")
        self.assertEqual(conffiles.split(), ["/etc/vitrine.conf", "/etc/logrotate.d/vitrine"])

    def test_its_programs_are_hardened(self):
        for name, may_lack in PROGRAMS.items():
            self.assertLessEqual(faults_of(self.folder / "files/usr/bin" / name), may_lack, name)

    def test_its_configuration_comments_defaults_out(self):
        lines = (self.folder / "files/etc/vitrine.conf").read_text().splitlines()
        in_force = [line for line in lines if line and not line.startswith("#")]
        self.assertEqual(in_force, ['data = "/var/lib/vitrine"', 'access-log = "/var/log/vitrine/access.log"'])
        self.assertIn('#listen = "127.0.0.1:8080"', lines)
        self.assertNotIn("from --", "".join(lines))

    def test_installed_it_serves_what_is_published_and_leaves_models_behind(self):
        with tempfile.TemporaryDirectory() as state:
            said = run("unshare", "--mount", "bash", "-c", MACHINE, env={
                "PATH": os.environ["PATH"] + ":/usr/sbin", "STATE": state, "PACKAGE": str(self.package),
                "MESH": str(MESH), "SCRIPT": TRIAL, "UNIT": UNIT})
        self.assertTrue(said.endswith("passed\n"), said)
        self.assertRegex(said, r"uid=\d+\(vitrine\) .*\(plugdev\)")
        self.assertIn("vitrine 700 /var/lib/vitrine\n", said)
        self.assertIn("vitrine 640 /var/log/vitrine/access.log.1\n", said)
        self.assertIn("CapEff:\t0000000000000000\nNoNewPrivs:\t1\n", said)
        self.assertIsNone(re.search("event=(warning|error|critical)", said), said)


if __name__ == "__main__":
    unittest.main()
