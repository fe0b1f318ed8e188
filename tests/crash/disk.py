#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the daemon on a full disk and on a failing disk.

On a full disk, requests that need space must fail with a clear message, and all others must succeed. On a failing disk,
requests and jobs that the fault affects must fail, and published models must still be served.

Usage: disk.py BINARIES
"""
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from crash import torus
from daemon import Client, Daemon, new_token

SIZE = 6 << 20  # size of the small disk, in bytes
HALF = 100_000  # bytes of one half of an upload


def upload(client, content):
    """Uploads `content`. Returns the status of the last response, and the path of the upload."""
    answer = client.tus("POST", "/api/v1/uploads", Upload_Length=len(content))
    if answer.status != 201:
        return answer.status, None
    path = answer.getheader("Location")
    return client.tus("PATCH", path, content, Upload_Offset=0).status, path


def job_of(client, path, **order):
    status, started = client.json("POST", "/api/v1/models", {"upload": path.rsplit("/", 1)[1], "publish": True, **order})
    assert status == 202, started
    while True:
        job = client.json("GET", "/api/v1/jobs/" + started["job"])[1]
        if job["state"] in ("done", "failed"):
            return job
        time.sleep(0.02)


def is_served(client, model):
    status, _ = client.json("GET", f"/api/v1/models/{model}/manifest")
    answer, body = client.ask("GET", f"/api/v1/models/{model}/file.pmesh")
    return status == 200 and answer.status == 200 and len(body) == int(answer.getheader("Content-Length"))


def doctors_word_on_the_disk(binaries, data):
    words = [str(binaries / "vitrine"), "doctor", "--data", str(data), "--json"]
    report = json.loads(subprocess.run(words, capture_output=True, text=True, check=False).stdout)
    return next(check for check in report["checks"] if check["check"] == "disk")


def an_upload_ends(client, path, data):
    """Checks that an upload for which the full disk has no room ends, and that its bytes become free."""
    answer = client.tus("PATCH", path, bytes(HALF), Upload_Offset=HALF)
    assert answer.status == 507, answer.status
    assert client.tus("HEAD", path).status == 404
    assert all(one["id"] not in path for one in client.json("GET", "/api/v1/uploads")[1]["uploads"])
    assert not list((data / "uploads").glob(path.rsplit("/", 1)[1] + "*"))
    disk = os.statvfs(data)
    assert disk.f_bavail * disk.f_frsize >= HALF, disk.f_bavail


def a_full_disk(binaries, data):
    subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={SIZE}", "tmpfs", str(data)], check=True)
    token = new_token(binaries, data)
    daemon = Daemon(binaries, data)
    client = Client(daemon, token)
    model = job_of(client, upload(client, torus(30, 20))[1])["model"]

    status, path = upload(client, bytes(2 * SIZE))
    assert status == 507 and path is None, (status, path)  # refused before its first byte
    assert is_served(client, model), "after an upload was refused"
    assert client.json("GET", "/api/v1/models")[0] == 200

    status, mesh = upload(client, torus(60, 40))
    assert status == 204, status
    half = client.tus("POST", "/api/v1/uploads", Upload_Length=2 * HALF).getheader("Location")
    assert client.tus("PATCH", half, bytes(HALF), Upload_Offset=0).status == 204
    filler = data / "filler"
    filler.write_bytes(b"")
    with open(filler, "ab", buffering=0) as file:
        try:
            while file.write(bytes(4096)):
                pass
        except OSError:
            pass
    for method, address, order in (("POST", "/api/v1/models", {"upload": mesh.rsplit("/", 1)[1], "publish": True}),
                                   ("PATCH", f"/api/v1/models/{model}", {"unit": "cm"})):
        status, problem = client.json(method, address, order)
        assert status == 507 and "free some space" in problem["detail"] and str(data) not in str(problem), (status, problem)
    assert is_served(client, model), "after a job was refused"
    an_upload_ends(client, half, data)
    filler.unlink()
    job = job_of(client, mesh)
    assert job["state"] == "done" and is_served(client, job["model"]), job
    disk = doctors_word_on_the_disk(binaries, data)
    assert disk["verdict"] == "fail" and "GB free of" in disk["detail"] and "free some space" in disk["advice"], disk
    assert daemon.stop() == 0
    assert any("free some space" in line for line in daemon.printed), daemon.printed


def a_failing_disk(binaries, data, control):
    token = new_token(binaries, data)
    daemon = Daemon(binaries, data, before=["fiu-run", "-x", "-f", str(control)])
    client = Client(daemon, token)
    model = job_of(client, upload(client, torus(30, 20))[1])["model"]

    def fiu(command):
        subprocess.run(["fiu-ctrl", "-f", str(control), "-c", command, str(daemon.process.pid)], check=True, capture_output=True)

    for point in ("posix/io/sync/fsync", "posix/io/rw/pwrite"):
        answer = client.tus("POST", "/api/v1/uploads", Upload_Length=1000)
        path = answer.getheader("Location")
        fiu(f"enable name={point},failinfo=5")
        answer = client.tus("PATCH", path, bytes(1000), Upload_Offset=0)
        assert answer.status == 500, (point, answer.status)
        assert is_served(client, model), point
        fiu(f"disable name={point}")
        offset = int(client.tus("HEAD", path).getheader("Upload-Offset"))
        assert client.tus("PATCH", path, bytes(1000 - offset), Upload_Offset=offset).status == 204, point
        assert client.tus("DELETE", path).status == 204
    collect_while_reading_fails(client, fiu, data)
    mesh = upload(client, torus(40, 20))[1]
    for number, words in ((5, "Input/output error"), (28, "No space left on device")):
        fiu(f"enable name=posix/io/rw/write,failinfo={number}")
        job = job_of(client, mesh)
        fiu("disable name=posix/io/rw/write")
        assert job["state"] == "failed" and words in job["error"], job
        assert len(client.json("GET", "/api/v1/models?drafts=true")[1]["models"]) == 1, "part of a model is seen"
        assert is_served(client, model), words
    assert job_of(client, mesh)["state"] == "done"
    assert daemon.stop() == 0


def collect_while_reading_fails(client, fiu, data):
    """Checks that a garbage collection skips files that it cannot read, and continues."""
    content = torus(12, 8)
    kept = upload(client, content)[1]
    doomed = job_of(client, upload(client, torus(20, 10))[1])["model"]
    objects = len(list((data / "objects").rglob("*")))
    for fault in ("enable name=posix/io/rw/read", "enable_random name=posix/io/oc/open,probability=0.5",
                  "enable_random name=posix/io/dir/readdir,probability=0.5"):
        fiu(f"{fault},failinfo=5")
        for _ in range(20):  # each successful PATCH starts a garbage collection
            client.json("PATCH", f"/api/v1/models/{doomed}", {"title": "doomed"})
            client.json("GET", "/api/v1/models")
        fiu("disable name=" + fault.split("name=")[1].split(",")[0])
    assert client.json("DELETE", f"/api/v1/models/{doomed}")[0] == 204
    while len(list((data / "objects").rglob("*"))) >= objects:
        time.sleep(0.02)
    answer = client.tus("HEAD", kept)
    assert answer.status == 200 and int(answer.getheader("Upload-Offset")) == len(content), answer.status
    assert client.tus("DELETE", kept).status == 204


def main():
    if os.environ.get("VITRINE_OWN_MOUNTS") != "yes":
        os.environ["VITRINE_OWN_MOUNTS"] = "yes"
        own = ["unshare", "--mount"] if os.getuid() == 0 else ["unshare", "--map-root-user", "--mount"]
        os.execvp("unshare", [*own, sys.executable, *sys.argv])
    binaries = Path(sys.argv[1])
    with tempfile.TemporaryDirectory(prefix="vitrine-") as folder:
        small, failing, control = (Path(folder) / name for name in ("small", "failing", "control"))
        small.mkdir()
        failing.mkdir()
        try:
            a_full_disk(binaries, small)
        finally:
            subprocess.run(["umount", "-l", str(small)], check=False)
        a_failing_disk(binaries, failing, control)
    print("ok")


if __name__ == "__main__":
    main()
