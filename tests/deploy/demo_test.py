#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the demo as a newcomer runs it. It must serve the page whose URL it prints, and end when it gets a signal."""
import fcntl
import json
import os
import re
import shutil
import signal
import socket
import struct
import subprocess
import tempfile
import time
import unittest
import urllib.request
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
DEMO = ROOT / "deploy" / "demo"


def setUpModule():
    """Brings up the loopback interface, because a new network namespace starts with it down."""
    set_flags, is_up = 0x8914, 1  # SIOCSIFFLAGS, IFF_UP
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as any_socket:
        fcntl.ioctl(any_socket, set_flags, struct.pack("16sh14x", b"lo", is_up))


class Demo(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)

    def start(self, listen, *arguments):
        """Starts the demo. Returns the process, its output up to the URL, and the URL."""
        environment = os.environ | {"VITRINE_LISTEN": listen, "VITRINE_DATA": self.folder + "/data", "VITRINE_STEPS": "24"}
        demo = subprocess.Popen([DEMO, *arguments], env=environment, text=True, stdin=subprocess.DEVNULL,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.addCleanup(demo.stdout.close)
        self.addCleanup(demo.kill)
        said = ""
        for line in demo.stdout:
            said += line
            if url := re.search(r"http://\S+/(models|scans)/\S+", line):
                return demo, said, url.group()
        self.fail("the demo ended without a URL:\n" + said)

    def stop(self, demo, how=signal.SIGINT):
        demo.send_signal(how)
        demo.stdout.read()
        self.assertEqual(demo.wait(timeout=60), 0)
        self.assertEqual(self.processes(), [])

    def processes(self):
        """Returns the command lines of all processes that use the test's folder."""
        lines = []
        for file in Path("/proc").glob("[0-9]*/cmdline"):
            try:
                lines.append(file.read_bytes().replace(b"\0", b" ").decode(errors="replace"))
            except OSError:
                pass  # the process has ended
        return [line for line in lines if self.folder in line]

    def mesh(self):
        file = Path(self.folder) / "own mesh.obj"
        file.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n")
        return str(file)

    def scan(self, url):
        return json.loads(self.page(url.replace("/scans/", "/api/v1/scans/")))

    def page(self, url):
        with urllib.request.urlopen(url, timeout=60) as answer:
            self.assertEqual(answer.status, 200)
            return answer.read().decode()

    def failed(self, listen, data):
        """Runs a demo that must fail to start, and returns its output. Checks that it leaves no files in the clone."""
        before = self.states()
        environment = os.environ | {"VITRINE_LISTEN": listen, "VITRINE_DATA": data}
        done = subprocess.run([DEMO, self.mesh()], env=environment, text=True, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertEqual(self.states(), before)
        return done.stdout

    def states(self):
        return set((ROOT / "build" / "demo").glob("*"))

    def refused(self, *arguments):
        done = subprocess.run([DEMO, *arguments], capture_output=True, text=True, cwd=self.folder)
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        return done.stderr

    def test_serves_the_page_it_names_and_stops_cleanly_twice(self):
        demo, _, url = self.start("127.0.0.1:0", self.mesh())
        self.assertIn("<progressive-mesh", self.page(url))
        self.stop(demo)
        again, _, second = self.start("127.0.0.1:0", self.mesh())
        self.assertEqual(second.rpartition("/")[2], url.rpartition("/")[2], "the model was published again")
        self.stop(again, signal.SIGTERM)

    def test_scans_the_mesh_that_ships_once(self):
        demo, _, url = self.start("127.0.0.1:0")
        self.assertIn("<canvas", self.page(url))
        while (scan := self.scan(url))["state"] not in ("done", "failed", "cancelled"):
            self.assertFalse([line for line in self.processes() if "vtr_" in line], "a token is in the list of processes")
            time.sleep(0.2)
        self.assertEqual((scan["state"], scan["steps"], scan["error"]), ("done", 24, None))
        self.assertIn("<progressive-mesh", self.page(url.partition("/scans/")[0] + f"/models/{scan['model']}"))
        self.stop(demo)
        again, said, second = self.start("127.0.0.1:0", "--scan")
        self.assertIn("to scan it again: rm '", said)
        self.assertEqual(self.scan(second), scan)
        self.stop(again, signal.SIGTERM)

    def test_takes_another_port_and_says_so_where_one_is_in_use(self):
        with socket.create_server(("127.0.0.1", 0)) as holder:
            port = holder.getsockname()[1]
            demo, said, url = self.start(f"127.0.0.1:{port}", self.mesh())
            self.assertIn(f"Port {port} is in use", said)
            self.assertNotIn(f":{port}/", url)
            self.page(url)
            self.stop(demo)

    def test_an_address_of_another_machine_is_not_called_in_use(self):
        said = self.failed("192.0.2.1:8080", self.folder + "/data")
        self.assertNotIn("in use", said)
        self.assertIn("cannot listen on 192.0.2.1:8080: Cannot assign requested address; choose another", said)

    def test_a_data_folder_that_cannot_be_written_is_named_in_one_line(self):
        file = Path(self.folder) / "file"
        file.write_text("not a folder")
        said = self.failed("127.0.0.1:0", f"{file}/data")
        self.assertEqual(said.splitlines()[-1], f"demo: cannot write to '{file}/data'; "
                                                "set VITRINE_DATA to a folder you may write to")
        self.assertNotIn("mkdir", said)

    def test_a_missing_file_and_an_unknown_option_are_refused_in_one_line(self):
        self.assertIn("cannot read", self.refused("missing.ply"))
        self.assertIn("unknown option", self.refused("--fast"))
        self.assertIn("one file at a time", self.refused("--scan", "a.ply", "b.ply"))


if __name__ == "__main__":
    unittest.main()
