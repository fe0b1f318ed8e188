#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Shifts the daemon's clock by an hour while jobs hold leases. Each job must make exactly one model, even after a kill.

Usage: clock.py BINARIES [JOBS]
"""
import mmap
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from crash import check_log, torus
from daemon import Client, Daemon, new_token
from disk import upload

HOUR = 3600
TIMEOUT = 60  # seconds until the test fails because a job does not end
POLL = 0.003  # seconds between two polls; without this pause, a fast computer exceeds the daemon's request rate


class Clock:
    """Controls the time of day that the daemon sees, by means of clock.c."""

    def __init__(self, folder):
        self.library, file = folder / "clock.so", folder / "offset"
        source = Path(__file__).with_name("clock.c")
        subprocess.run(["cc", "-O1", "-shared", "-fPIC", "-o", str(self.library), str(source)], check=True)
        file.write_bytes(bytes(8))
        with open(file, "r+b") as shared:
            self.offset = mmap.mmap(shared.fileno(), 8)
        self.environment = ["env", f"LD_PRELOAD={self.library}", f"CLOCK_OFFSET={file}"]

    def jump(self, seconds):
        self.offset[:] = struct.pack("=q", seconds)


def start_job(client, mesh):
    path = upload(client, mesh)[1]
    status, started = client.json("POST", "/api/v1/models", {"upload": path.rsplit("/", 1)[1], "publish": True})
    assert status == 202, started
    return started["job"]


def wait_for(client, job, states, jump=lambda: None):
    """Waits until a job is in one of `states`, and returns its record. Calls `jump` after each poll."""
    end = time.monotonic() + TIMEOUT
    while True:
        status, record = client.json("GET", f"/api/v1/jobs/{job}")
        assert status == 200, record
        if record["state"] in states:
            return record
        assert time.monotonic() < end, f"a job does not end: {record}"
        jump()
        time.sleep(POLL)


def check(client, jobs):
    """Checks that each job has succeeded and made one model, and that there are no other models."""
    made = [wait_for(client, job, ("done", "failed")) for job in jobs]
    assert all(record["state"] == "done" for record in made), made
    models = [model["id"] for model in client.json("GET", "/api/v1/models?drafts=true&limit=200")[1]["models"]]
    assert sorted(models) == sorted(record["model"] for record in made), (models, made)


def jump_while_jobs_run(client, clock, count):
    """Runs `count` jobs. After each poll of a job, shifts the clock forwards, back or to the right time. Returns the jobs."""
    jobs, jumps = [], [HOUR, 0, -HOUR, 0]
    for number in range(count):
        jobs.append(start_job(client, torus(40 + number, 30)))
        wait_for(client, jobs[-1], ("done", "failed"), lambda: clock.jump(jumps.append(jumps.pop(0)) or jumps[0]))
    clock.jump(0)
    check(client, jobs)
    return jobs


def kill_with_a_lease_of_the_future(binaries, data, token, clock, jobs):
    """Kills the daemon while its clock is an hour fast, so that the lease of its job ends an hour too late. Adds the job to `jobs`."""
    daemon = Daemon(binaries, data, before=clock.environment)
    try:
        client = Client(daemon, token)
        clock.jump(HOUR)
        jobs.append(start_job(client, torus(300, 60)))
        record = wait_for(client, jobs[-1], ("running", "done", "failed"))
        assert record["state"] == "running", f"the mesh is too small for this test: {record}"
        assert record["created"] > time.strftime("%FT%TZ", time.gmtime(time.time() + HOUR / 2)), "the clock did not jump"
    finally:
        daemon.kill()
    clock.jump(0)
    check_log(daemon)


def main():
    binaries, count = Path(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 6
    with tempfile.TemporaryDirectory(prefix="vitrine-") as folder:
        data, clock = Path(folder) / "data", Clock(Path(folder))
        data.mkdir()
        token = new_token(binaries, data)
        daemon = Daemon(binaries, data, before=clock.environment)
        try:
            jobs = jump_while_jobs_run(Client(daemon, token), clock, count)
        finally:
            code = daemon.stop()
        assert code == 0, daemon.printed[-3:]
        check_log(daemon)
        kill_with_a_lease_of_the_future(binaries, data, token, clock, jobs)
        daemon = Daemon(binaries, data, before=clock.environment)
        try:
            check(Client(daemon, token), jobs)
        finally:
            daemon.stop()
        check_log(daemon)
    print("ok")


if __name__ == "__main__":
    main()
