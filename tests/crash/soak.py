#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the daemon under load and faults for hours, and checks its data after each start.

Usage: soak.py BINARIES [HOURS [SEED]]
       soak.py BINARIES brief [SEED]

An operator works as in crash.py. Meanwhile, some changes of the disk fail as if it were full, the clock jumps, and mutated
requests and frames arrive. Each daemon runs for some minutes and is ended by SIGKILL or SIGTERM. The script makes the checks
of crash.py, and checks that `vitrine doctor --scrub` finds no damage and that the daemon's memory stays below a limit. Every
tenth daemon runs for longer: in a run of ten hours or more, for 30 to 60 minutes. In the second half of this time, neither its
memory nor the number of its descriptors may grow. `brief` makes a fixed number of faults, which take about half a minute.
Prints a line for each daemon.
"""
import collections
import random
import re
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

from clock import HOUR, Clock
from crash import Known, Look, Work
from daemon import Client, Daemon, Gone, new_token
from full_disk import Disk
from fuzz import OPTIONS, STATUS, Requests, frame, messages, mutated_request, talk
from mutations import mutated

LIFE = (20, 300)  # shortest and longest time in seconds for which most daemons run
LONG_LIFE = (1800, 3600)  # shortest and longest time in seconds for which every tenth daemon runs
RUN = 10  # default duration in hours; LONG_LIFE is scaled down in a shorter run
BRIEF = (4, 16, 4)  # number of faults of each daemon in a brief run; check_growth() checks only the second daemon
SAMPLES = 16  # number of times at which a daemon with a long life is idle and its memory and descriptors are counted
BACKLOG = 10  # number of jobs that the operator has open at once
GROWTH = 4 << 20  # bytes by which the memory of a daemon may grow from the third to the fourth quarter of a long life
COLD_GROWTH = 64 << 20  # replaces GROWTH in a run of less than RUN hours, in which caches still grow
MORE_DESCRIPTORS = 4  # number of descriptors by which a daemon may use more in the fourth quarter than in the third
PAUSE = 0.5  # time in seconds between two faults
MEMORY = 300 << 20  # largest resident memory of the idle daemon, in bytes
UPGRADE = ("GET /api/v1/models/{}/stream HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
           "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Protocol: pmesh.v1\r\n\r\n")


class LongWork(Work):
    """Makes an operator's requests, which can be suspended. Continues after a broken connection as long as the daemon runs."""

    kept = 10

    def __init__(self, daemon, token, dice, known):
        super().__init__(daemon, token, dice, known)
        self.daemon = daemon
        self.may_work, self.is_suspended = threading.Event(), threading.Event()
        self.may_work.set()

    def one(self):
        if not self.may_work.is_set():
            self.is_suspended.set()
            self.may_work.wait()
        try:
            super().one()
        except Gone:
            self.known.ordered.add(self.patched)  # the daemon may have ended this upload for lack of space
            if self.daemon.process.poll() is not None:
                raise

    def make(self):
        if len(open_jobs(self.client)) < BACKLOG:
            super().make()

    def suspend(self):
        """Waits until the operator has suspended its requests. Returns immediately if the operator has ended."""
        self.is_suspended.clear()
        self.may_work.clear()
        while self.is_alive() and not self.is_suspended.wait(0.1):
            pass

    def resume(self):
        self.may_work.set()


def open_jobs(client):
    return [job for job in client.json("GET", "/api/v1/jobs?limit=50")[1].get("jobs", []) if job["ended"] is None]


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


def check_growth(samples, most):
    """Checks that an idle daemon grew little from the third to the fourth quarter. `samples` are pairs of memory and descriptors."""
    half, quarter = len(samples) // 2, len(samples) // 4
    memory, descriptors = ([min(part) for part in (values[half:-quarter], values[-quarter:])] for values in zip(*samples))
    text = f"{memory[0] / 1e6:.1f} and {memory[1] / 1e6:.1f} MB, {descriptors[0]} and {descriptors[1]} descriptors in the third and fourth quarter"
    assert memory[1] - memory[0] <= most, f"the memory grows: {text}"
    assert descriptors[1] - descriptors[0] <= MORE_DESCRIPTORS, f"the number of descriptors grows: {text}"
    return text


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

    def idle(self, daemon, work, faults):
        """Returns the daemon's memory and number of descriptors while no request and no job runs."""
        faults.end()
        work.suspend()
        try:
            client = Client(daemon, self.token)
            self.look.until("a job does not end", lambda: not open_jobs(client))
            client.connection.close()
            return daemon.resident(), len(daemon.descriptors())
        finally:
            work.resume()  # otherwise its thread would never end

    def live(self, progress, growth=None):
        """Runs one daemon with faults until `progress(number of faults)` reaches 1. Checks its growth if the limit `growth` is given.

        Returns a line of text about the run.
        """
        preloaded = f"LD_PRELOAD={self.disk.library}:{self.clock.library}"
        environment = ["env", *self.disk.environment()[1:], *self.clock.environment[1:], preloaded,  # the last LD_PRELOAD is the one in effect
                       "MALLOC_ARENA_MAX=1"]  # otherwise each thread fills its own arena, so memory also grows without a leak
        daemon, samples, grown = Daemon(self.binaries, self.data, OPTIONS, environment), [], ""
        try:
            self.look.at(Client(daemon, self.token), self.known)
            faults = Faults(daemon, self.reader, self.disk, self.clock, self.dice)
            work = LongWork(daemon, self.token, random.Random(self.dice.random()), self.known)
            work.start()
            while (share := progress(sum(faults.seen.values()))) < 1 and work.is_alive():
                if growth and share * SAMPLES >= len(samples):
                    samples.append(self.idle(daemon, work, faults))
                faults.one()
                time.sleep(PAUSE)
            memory = self.idle(daemon, work, faults)[0]
            if growth and work.is_alive():
                grown = check_growth(samples, growth) + ", "
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
        return f"{grown}{memory / 1e6:.0f} MB, {self.look.ended} jobs ended, {kept} models kept, {dict(faults.seen)}, {end_by.__name__}"


def run_for(soak, hours, dice):
    """Runs daemons for `hours` hours."""
    end, scale, number = time.monotonic() + 3600 * hours, min(1, hours / RUN), 0
    while (left := end - time.monotonic()) > 0:
        number += 1
        is_long = number % 10 == 2  # the first long life is early, so that a short run contains it
        seconds = min(left, dice.uniform(*LONG_LIFE) * scale if is_long else dice.uniform(*LIFE))
        is_judged, start = is_long and seconds >= LONG_LIFE[0] * scale, time.monotonic()
        limit = (GROWTH if scale == 1 else COLD_GROWTH) if is_judged else None
        text = soak.live(lambda _, start=start, seconds=seconds: (time.monotonic() - start) / seconds, limit)
        print(f"{left / 60:6.1f} min left: {text}", flush=True)


def main():
    binaries, length = Path(sys.argv[1]), sys.argv[2] if len(sys.argv) > 2 else str(RUN)
    seed = int(sys.argv[3]) if len(sys.argv) > 3 else random.SystemRandom().randrange(1 << 32)
    print(f"{length}{' h' if length != 'brief' else ''}, seed {seed}", flush=True)
    with tempfile.TemporaryDirectory(prefix="vitrine-") as folder:
        dice = random.Random(seed)
        soak = Soak(binaries, Path(folder), dice)
        if length == "brief":
            for number, most in enumerate(BRIEF):
                print(soak.live(lambda count, most=most: count / most, COLD_GROWTH if number == 1 else None), flush=True)
        else:
            run_for(soak, float(length), dice)
        print(f"at the end: {soak.live(lambda _: 1)}")
        assert soak.look.verified, "no model was made"
    print("ok")


if __name__ == "__main__":
    main()
