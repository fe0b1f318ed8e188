#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The Debian package installs, makes its user, and its service starts from its unit's own command line.
VITRINE_BUILD: the build whose programs are packed."""
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ["VITRINE_BUILD"])
MESH = ROOT / "tests" / "models" / "demosthenes.obj"

# This machine with the package on it, in mounts, processes and a network of its own that end with the script.
MACHINE = """set -euo pipefail
ip link set lo up
mount -t tmpfs none "$STATE"
mkdir "$STATE/upper" "$STATE/work" "$STATE/root"
mount -t overlay none -o "lowerdir=/,upperdir=$STATE/upper,workdir=$STATE/work" "$STATE/root"
mount -t proc none "$STATE/root/proc"
mount --rbind /dev "$STATE/root/dev"
cp "$PACKAGE" "$STATE/root/tmp/vitrine.deb"
cp "$MESH" "$STATE/root/tmp/bust.obj"
exec chroot "$STATE/root" bash -euo pipefail -c "$SCRIPT"
"""

SERVES = r"""
dpkg --install /tmp/vitrine.deb
as_user() { runuser --user vitrine -- "$@"; }
id vitrine
systemd-analyze verify /lib/systemd/system/vitrined.service
as_user vitrined --config=/etc/vitrine.conf --check-config
command=$(sed -n 's/^ExecStart=//p' /lib/systemd/system/vitrined.service)
setpriv --reuid vitrine --regid vitrine --init-groups $command 2>/tmp/log &
id=$(as_user vitrine publish /tmp/bust.obj --data /var/lib/vitrine --json | jq -r .id)
head() { curl -fsS --retry 50 --retry-connrefused --retry-delay 1 -o /tmp/head "http://127.0.0.1:8080/api/v1/models/$id/head"; }
head
as_user vitrine token create --role viewer --data /var/lib/vitrine >/dev/null
stat -c '%U %a %n' /var/lib/vitrine /var/log/vitrine /var/log/vitrine/access.log
until test -s /var/log/vitrine/access.log; do head; done
logrotate --force /etc/logrotate.d/vitrine
test -s /var/log/vitrine/access.log.1
kill -USR1 $!  # as the rotation has systemd do it
kill -TERM $!
wait $!
test -e /var/log/vitrine/access.log
! grep -E 'event=(warning|error|critical)' /tmp/log
dpkg --purge vitrine
test -s /var/lib/vitrine/catalogue.sqlite
test ! -e /etc/vitrine.conf
test ! -e /var/log/vitrine
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

    def test_its_configuration_comments_defaults_out(self):
        run("dpkg-deb", "--extract", self.package, self.folder / "files")
        lines = (self.folder / "files/etc/vitrine.conf").read_text().splitlines()
        in_force = [line for line in lines if line and not line.startswith("#")]
        self.assertEqual(in_force, ['data = "/var/lib/vitrine"', 'access-log = "/var/log/vitrine/access.log"'])
        self.assertIn('#listen = "127.0.0.1:8080"', lines)
        self.assertNotIn("from --", "".join(lines))

    def test_installed_it_serves_what_its_user_publishes_and_leaves_models_behind(self):
        with tempfile.TemporaryDirectory() as state:
            environment = os.environ | {"STATE": state, "PACKAGE": str(self.package), "MESH": str(MESH), "SCRIPT": SERVES}
            environment = {name: value for name, value in environment.items() if not name.startswith("VITRINE_")}
            said = run("unshare", "--mount", "--net", "--pid", "--fork", "--kill-child", "bash", "-c", MACHINE, env=environment)
        self.assertRegex(said, r"uid=\d+\(vitrine\) .*\(plugdev\)")
        self.assertIn("vitrine 750 /var/lib/vitrine\n", said)
        self.assertIn("vitrine 640 /var/log/vitrine/access.log\n", said)


class Unit(unittest.TestCase):
    def test_it_exposes_little(self):
        unit = ROOT / "deploy" / "vitrined.service"
        print(run("systemd-analyze", "security", "--offline=true", "--threshold=20", "--no-pager", unit).splitlines()[-1])


if __name__ == "__main__":
    unittest.main()
