#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the daemon under load and faults for hours, and checks its data after each start.

Usage: soak.py BINARIES [HOURS [SEED]]

An operator works as in crash.py. Meanwhile, some changes of the disk fail as if it were full, the clock jumps, and mutated
requests and frames arrive. Each daemon runs for some minutes and is ended by SIGKILL or SIGTERM. The script makes the checks
of crash.py, and checks that `vitrine doctor --scrub` finds no damage and that the daemon's memory stays below a limit.
Prints a line for each daemon.
"""
import collections
import random
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from clock import HOUR, Clock
from crash import Known, Look, Work
from daemon import Client, Daemon, new_token
from full_disk import Disk
from fuzz import OPTIONS, STATUS, Requests, frame, messages, mutated_request, talk
from mutations import mutated

LIFE = (20, 300)  # shortest and longest time in seconds for which a daemon runs
PAUSE = 0.5  # time in seconds between two faults
MEMORY = 300 << 20  # largest resident memory of the daemon, in bytes
UPGRADE = ("GET /api/v1/models/{}/stream HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
           "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Protocol: pmesh.v1\r\n\r\n")


class LongWork(Work):
    kept = 10


class LookAfterFaults(Look):
    """Makes the checks of crash.py, but asks for each job by its ID, because the list of all jobs would become too long."""

    ended = 0  # number of jobs that have ended

    def may_fail(self, error):
        return super().may_fail(error) or "No space left" in error or "is full" in error

    def jobs_have_ended(self, client, known):
        for path in sorted(known.jobs):
            status, job = client.json("GET", "/api/v1/jobs/" + path)
            assert status == 200, f"job {path} is lost: {status}"
            if job["state"] not in ("done", "failed", "cancelled"):
                return False
            assert job["state"] != "failed" or self.may_fail(job["error"]), f"a job failed: {job}"
            if job["state"] == "done":
                known.made.add(job["model"])
            known.jobs.remove(path)
            self.ended += 1
        return True


class Faults:
    """Causes random faults of a daemon, and sends hostile requests with a token that permits no changes."""

    def __init__(self, daemon, reader, disk, clock, dice):
        self.daemon, self.disk, self.clock, self.dice = daemon, disk, clock, dice
        client = Client(daemon, reader)
        document, model = client.json("GET", "/api/v1/openapi.json")[1], self.a_model(client)
        names = {"MODEL": model, "JOB": model, "UPLOAD": model, "CHUNK": "0" * 64}
        client.connection.close()
        self.model, self.requests, self.messages = model, Requests(document, reader, names).all, messages(model)
        self.seen = collections.Counter()

    @staticmethod
    def a_model(client):
        models = client.json("GET", "/api/v1/models")[1]["models"]
        return models[0]["id"] if models else "01arz3ndektsv4rrffq69g5fav"

    def one(self):
        fault = self.dice.choice([self.fill_disk, self.jump, self.send_requests, self.send_frames])
        self.seen[fault.__name__] += 1
        fault()

    def fill_disk(self):
        first = self.dice.randint(1, 60)
        self.disk.fail(first, first + self.dice.choice([0, 2, 20]))

    def jump(self):
        self.clock.jump(self.dice.choice([-HOUR, 0, HOUR]))

    def send_requests(self):
        for _ in range(50):
            self.check(talk(self.daemon.port, mutated_request(self.dice, self.requests)))

    def send_frames(self):
        for _ in range(20):
            content = frame(self.dice, mutated(self.dice, self.messages)) + mutated(self.dice, [frame(self.dice, m) for m in self.messages])
            self.check(talk(self.daemon.port, UPGRADE.format(self.model).encode() + content)[:20])

    @staticmethod
    def check(answer):
        bad = [status for status in STATUS.findall(answer) if status in (b"500", b"502", b"504")]
        assert not bad, answer[:500]

    def end(self):
        self.disk.heal()
        self.clock.jump(0)


def resident(daemon):
    return int(re.search(r"VmRSS:\s+(\d+)", Path(f"/proc/{daemon.process.pid}/status").read_text(encoding="ascii"))[1]) << 10


def scrub(binaries, data):
    words = [str(binaries / "vitrine"), "doctor", "--data", str(data), "--scrub"]
    result = subprocess.run(words, capture_output=True, text=True, check=False)
    for check in ("objects", "integrity", "catalogue"):
        assert not re.search(rf"^fail +{check}", result.stdout, re.M), result.stdout


class Soak:
    def __init__(self, binaries, folder, dice):
        self.binaries, self.data, self.dice, self.known = binaries, folder / "data", dice, Known()
        self.data.mkdir()
        self.disk, self.clock, self.look = Disk(folder), Clock(folder), LookAfterFaults(binaries, self.data)
        self.token, self.reader = new_token(binaries, self.data), new_token(binaries, self.data, "viewer")

    def live(self, seconds):
        """Runs one daemon with faults for `seconds` seconds. Returns a line of text about the run."""
        preloaded = f"LD_PRELOAD={self.disk.library}:{self.clock.library}"
        environment = ["env", *self.disk.environment()[1:], *self.clock.environment[1:], preloaded]  # the last LD_PRELOAD is the one in effect
        daemon = Daemon(self.binaries, self.data, OPTIONS, environment)
        try:
            self.look.at(Client(daemon, self.token), self.known)
            faults = Faults(daemon, self.reader, self.disk, self.clock, self.dice)
            work = LongWork(daemon, self.token, random.Random(self.dice.random()), self.known)
            work.start()
            end = time.monotonic() + seconds
            while time.monotonic() < end and work.is_alive():
                faults.one()
                time.sleep(PAUSE)
            faults.end()
            memory = resident(daemon)
        except BaseException:
            daemon.kill()
            print("".join(line for line in daemon.printed[-40:] if "event=audit" not in line))
            raise
        end_by = self.dice.choice([daemon.kill, daemon.kill, daemon.stop])
        end_by()
        work.join()
        if work.fault:
            raise work.fault
        assert memory < MEMORY, f"the daemon uses {memory} bytes"
        assert not any("terminate called" in line for line in daemon.printed)
        scrub(self.binaries, self.data)
        self.known.made -= self.known.deleted
        kept = len(self.known.made)
        return f"{memory / 1e6:.0f} MB, {self.look.ended} jobs ended, {kept} models kept, {dict(faults.seen)}, {end_by.__name__}"


def main():
    binaries, hours = Path(sys.argv[1]), float(sys.argv[2]) if len(sys.argv) > 2 else 10
    seed = int(sys.argv[3]) if len(sys.argv) > 3 else random.SystemRandom().randrange(1 << 32)
    print(f"{hours} h, seed {seed}", flush=True)
    with tempfile.TemporaryDirectory(prefix="vitrine-") as folder:
        dice, end = random.Random(seed), time.monotonic() + 3600 * hours
        soak = Soak(binaries, Path(folder), dice)
        while (left := end - time.monotonic()) > 0:
            print(f"{left / 60:6.1f} min left: {soak.live(min(left, dice.uniform(*LIFE)))}", flush=True)
        print(f"at the end: {soak.live(0)}")
        assert soak.look.verified, "no model was made"
    print("ok")


if __name__ == "__main__":
    main()
