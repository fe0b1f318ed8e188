#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Publishes models while a change of the disk fails, for each change that a publication makes.

Usage: full_disk.py BINARIES [MORE...]

Changes are writes, syncs, new files and folders, links and renames, including those of SQLite. Each argument MORE (default
2) stands for a series of publications. In each publication, the n-th change and the MORE changes after it fail, so that
cleaning up fails, too. Then n increases by MORE + 1.

A request that fails for lack of space must get the status 507, or 503 if the catalogue fails. After each publication, the
daemon must serve all confirmed models whole, and list no others. Once there is space, the same upload must become a model.
At the end, the store must hold no other objects, `vitrine doctor` must find no damage, and the daemon must start again.
"""
import hashlib
import itertools
import mmap
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from crash import Look, torus
from daemon import Client, Daemon, new_token

NO_ROOM = (503, 507)  # statuses of requests that a full disk prevents
TIMEOUT = 60  # seconds until the test fails because a job does not end


class Disk:
    """Controls which changes of the disk fail for the daemon, by means of full_disk.c."""

    def __init__(self, folder):
        self.library, self.file = folder / "full_disk.so", folder / "control"
        source = Path(__file__).with_name("full_disk.c")
        subprocess.run(["cc", "-O1", "-shared", "-fPIC", "-o", str(self.library), str(source)], check=True)
        self.file.write_bytes(bytes(12))
        with open(self.file, "r+b") as file:
            self.control = mmap.mmap(file.fileno(), 12)

    def environment(self):
        return ["env", f"LD_PRELOAD={self.library}", f"FULL_DISK={self.file}"]

    def fail(self, first, last):
        self.control[:] = struct.pack("=III", first, last, 0)

    def heal(self):
        """Lets all later changes succeed. Returns the number of changes since fail()."""
        steps = struct.unpack("=III", self.control)[2]
        self.control[:8] = bytes(8)
        return steps


def accepted(status, success):
    assert status == success or status in NO_ROOM, status
    return status == success


class Publisher:
    def __init__(self, client):
        self.client, self.files = client, {}  # model -> SHA-256 of the file of each confirmed model
        self.refused, self.failed = 0, 0

    def upload(self, content):
        """Uploads `content`. Returns the ID of the upload, or None if the daemon refuses it for lack of space."""
        answer = self.client.tus("POST", "/api/v1/uploads", Upload_Length=len(content))
        if not accepted(answer.status, 201):
            return None
        path = answer.getheader("Location")
        status = self.client.tus("PATCH", path, content, Upload_Offset=0).status
        return path.rsplit("/", 1)[1] if accepted(status, 204) else None

    def job(self, upload):
        """Makes a model of an upload. Returns the ended job, or None if the daemon refuses the job for lack of space."""
        status, started = self.client.json("POST", "/api/v1/models", {"upload": upload, "publish": True, "metadata": {"title": "Torus"}})
        return self.ended(started["job"]) if accepted(status, 202) else None

    def ended(self, job):
        end = time.monotonic() + TIMEOUT
        while (record := self.client.json("GET", "/api/v1/jobs/" + job)[1]).get("state") not in ("done", "failed"):
            assert time.monotonic() < end, f"a job does not end: {record}"
            time.sleep(0.005)
        return record

    def publish(self, content):
        """Publishes a mesh on a disk that may be full. Returns the ID of the upload if its job failed or was refused, else None."""
        upload = self.upload(content)
        job = upload and self.job(upload)
        if job and job["state"] == "done":
            self.files[job["model"]] = None
            return None
        self.refused, self.failed = self.refused + (job is None), self.failed + (job is not None)
        return upload

    def check(self):
        """Checks that the daemon serves the confirmed models whole, and lists no others."""
        for drafts in ("", "?drafts=true&limit=200"):
            seen = {model["id"] for model in self.client.json("GET", "/api/v1/models" + drafts)[1]["models"]}
            assert seen <= self.files.keys(), "part of a model is seen"
            assert not drafts or seen == self.files.keys(), "a model is lost"
        for model, known in self.files.items():
            status, manifest = self.client.json("GET", f"/api/v1/models/{model}/manifest")
            file = self.client.ask("GET", f"/api/v1/models/{model}/file.pmesh")[1]
            named = hashlib.sha256(file).hexdigest()
            assert status == 200 and named == manifest["sha256"] and known in (None, named), f"model {model} has changed"
            self.files[model] = named

    def remove(self, kept):
        for model in [model for model in self.files if model != kept]:
            assert self.client.json("DELETE", "/api/v1/models/" + model)[0] == 204
            del self.files[model]


def fail_each(publisher, disk, kept, more):
    """Publishes while change n and the `more` changes after it fail, until n exceeds the number of changes. Returns that number."""
    for n in itertools.count(1, more + 1):
        content = torus(12 + n % 50, 8 + n // 50)
        disk.fail(n, n + more)
        upload = publisher.publish(content)
        steps = disk.heal()
        publisher.check()
        if upload:  # the upload is complete, so the daemon must have kept it
            job = publisher.job(upload)
            assert job and job["state"] == "done", (n, job)
            publisher.files[job["model"]] = None
            publisher.check()
        publisher.remove(kept)
        if steps < n:
            return steps


def run(binaries, folder, data, series):
    disk, token = Disk(folder), new_token(binaries, data)
    daemon = Daemon(binaries, data, ["--max-uploads", "1000", "--scrub-rate", "0"], disk.environment())
    try:
        publisher = Publisher(Client(daemon, token))
        assert publisher.publish(torus(30, 20)) is None
        kept, = publisher.files
        for more in series:
            steps = fail_each(publisher, disk, kept, more)
            print(f"{steps} changes, {1 + more} fail: {publisher.refused} requests refused, {publisher.failed} jobs failed", flush=True)
            assert publisher.refused > 0 and publisher.failed > 0
            publisher.refused = publisher.failed = 0
    except BaseException:
        daemon.kill()
        print("".join(line for line in daemon.printed[-40:] if "event=audit" not in line))
        raise
    assert daemon.stop() == 0, daemon.printed[-3:]
    return token, publisher


def check_all(binaries, data, token, publisher):
    """Starts the daemon again and checks its models. Then checks that nothing else is stored, and that the doctor finds no damage."""
    daemon = Daemon(binaries, data)
    try:
        publisher.client = Client(daemon, token)
        publisher.check()
        look = Look(binaries, data)
        assert look.until_clean(publisher.client, look.models(publisher.client)), "orphans are left"
    finally:
        code = daemon.stop()
    doctor = subprocess.run([str(binaries / "vitrine"), "doctor", "--data", str(data), "--scrub"], capture_output=True, text=True, check=False)
    assert code == 0 and "damaged" not in doctor.stdout.replace("none damaged", ""), doctor.stdout


def main():
    binaries, series = Path(sys.argv[1]), [int(word) for word in sys.argv[2:]] or [2]
    with tempfile.TemporaryDirectory(prefix="vitrine-") as folder:
        data = Path(folder) / "data"
        data.mkdir()
        check_all(binaries, data, *run(binaries, Path(folder), data, series))
    print("ok")


if __name__ == "__main__":
    main()
