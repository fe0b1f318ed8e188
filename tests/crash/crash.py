#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Kills the daemon at random points of an operator's requests, starts it again, and checks its data.

Usage: crash.py BINARIES [KILLS [SEED]]

The operator uploads, builds, publishes, replaces and deletes models, hides their finer levels, and collects garbage. After
each start:
- Every model's file is the one that its manifest names, and passes `vitrine verify`.
- Every upload contains all bytes that were acknowledged.
- Every job ends, and is done if it has stored its model.
- No model is missing, unless its deletion was requested.
- After a garbage collection, the store contains exactly the objects that models name.
"""
import hashlib
import math
import random
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

from daemon import Client, Daemon, Gone, new_token

MOST = 40  # maximum number of requests before the kill is planned
LONGEST = 0.05  # maximum number of seconds from the last of these requests to the kill
TIMEOUT = 120  # seconds until the test fails because a job or a garbage collection does not end


def torus(rings, sides):
    """Returns a mesh file of a torus. Different counts give different meshes."""
    lines = []
    for i in range(rings):
        for j in range(sides):
            a, b = 2 * math.pi * i / rings, 2 * math.pi * j / sides
            r = 3 + math.cos(b)
            lines.append(f"v {r * math.cos(a):.6f} {r * math.sin(a):.6f} {math.sin(b):.6f}")
    for i in range(rings):
        for j in range(sides):
            p = [u * sides + v + 1 for u, v in ((i, j), ((i + 1) % rings, j), ((i + 1) % rings, (j + 1) % sides), (i, (j + 1) % sides))]
            lines += [f"f {p[0]} {p[1]} {p[2]}", f"f {p[0]} {p[2]} {p[3]}"]
    return "\n".join(lines).encode()


class Known:
    """Records what the responses of all daemons so far have told the operator."""

    def __init__(self):
        self.uploads = {}  # path -> [content of the file, number of acknowledged bytes]
        self.ordered = set()  # paths of uploads named in a request for a job; the job may have consumed them
        self.jobs = set()  # jobs that the daemon has accepted
        self.made = set()  # models of jobs that have succeeded
        self.deleted = set()  # models whose deletion was requested

    def is_gone(self, path):
        if path not in self.ordered:
            raise AssertionError(f"{path} is lost: {self.uploads[path][1]} bytes of it were acknowledged")
        del self.uploads[path]


class Work(threading.Thread):
    """Makes an operator's requests until the daemon is killed."""

    kept = 2  # number of models that are never deleted
    patched = None  # path of the upload that has received the last piece

    def __init__(self, daemon, token, dice, known):
        super().__init__()
        self.dice, self.known, self.uploads, self.fault = dice, known, known.uploads, None
        self.client = Client(daemon, token, self.dice.randint(1, MOST))

    def run(self):
        try:
            while True:
                self.one()
        except Gone:
            pass
        except Exception as fault:  # pylint: disable=broad-except
            self.fault = fault
            self.client.enough.set()

    def one(self):
        self.dice.choice([self.upload, self.go_on, self.make, self.make, self.change, self.delete])()

    def upload(self):
        mesh = torus(self.dice.randint(12, 40), self.dice.randint(8, 20))
        answer = self.client.tus("POST", "/api/v1/uploads", Upload_Length=len(mesh))
        if answer.status == 201:
            self.uploads[answer.getheader("Location")] = [mesh, 0]

    def go_on(self):
        for path in self.dice.sample(sorted(self.uploads), min(2, len(self.uploads))):
            mesh, sent = self.uploads[path]
            answer = self.client.tus("HEAD", path)
            if answer.status == 404:
                self.known.is_gone(path)
            if answer.status != 200:
                continue
            offset = int(answer.getheader("Upload-Offset"))
            if offset < sent:
                raise AssertionError(f"{path} had {sent} bytes and has {offset}")
            self.uploads[path][1] = offset  # the client will not send these bytes again
            piece = mesh[offset:offset + self.dice.choice([len(mesh), self.dice.randint(1, len(mesh))])]
            if not piece:
                continue
            self.patched = path
            answer = self.client.tus("PATCH", path, piece, Upload_Offset=offset)
            if answer.status == 204:
                self.uploads[path][1] = offset + len(piece)
            if answer.status == 507:
                del self.uploads[path]  # the disk has no room for the piece, so the daemon has ended the upload

    def make(self):
        self.go_on()
        whole = [path for path, (mesh, sent) in self.uploads.items() if sent == len(mesh)]
        if not whole:
            return
        path = self.dice.choice(whole)
        order = {"upload": path.rsplit("/", 1)[1], "publish": self.dice.random() < 0.8,
                 "metadata": {"title": f"model {self.dice.random()}"}}
        if (models := self.models()) and self.dice.random() < 0.3:
            order["replace"] = self.dice.choice(models)
        self.known.ordered.add(path)
        status, answer = self.client.json("POST", "/api/v1/models", order)
        if status == 202:
            self.known.jobs.add(answer["job"])

    def models(self):
        return [model["id"] for model in self.client.json("GET", "/api/v1/models?drafts=true")[1].get("models", [])]

    def change(self):
        if models := self.models():
            body = self.dice.choice([{"public_max_level": 1}, {"public_max_level": None}, {"unit": self.dice.choice(["mm", "cm"])},
                                     {"title": f"title {self.dice.random()}"}])
            self.client.json("PATCH", "/api/v1/models/" + self.dice.choice(models), body)

    def delete(self):
        if len(models := self.models()) > self.kept:
            model = self.dice.choice(models)
            self.known.deleted.add(model)
            if self.client.json("DELETE", "/api/v1/models/" + model)[0] >= 500:
                self.known.deleted.remove(model)  # the daemon says that it has not deleted the model


class Look:
    """Checks the daemon's data after each start."""

    def __init__(self, binaries, data):
        self.binaries, self.data, self.verified = binaries, data, set()

    def at(self, client, known):
        self.uploads(client, known)
        self.until("a job does not end", lambda: self.jobs_have_ended(client, known))
        self.nothing_is_lost(client, known)
        names = self.models(client)
        if names is not None and not self.until_clean(client, names):
            raise AssertionError(f"orphans: {self.stored() ^ names}")

    def until(self, what, holds):
        end = time.monotonic() + TIMEOUT
        while not holds():
            if time.monotonic() > end:
                raise AssertionError(what)
            time.sleep(0.02)

    def uploads(self, client, known):
        for path, (mesh, sent) in list(known.uploads.items()):
            answer = client.tus("HEAD", path)
            if answer.status == 404:
                known.is_gone(path)
                continue
            offset = int(answer.getheader("Upload-Offset") or -1)
            try:
                held = (self.data / "uploads" / (path.rsplit("/", 1)[1] + ".part")).read_bytes()
            except FileNotFoundError:  # a continued job has used the upload meanwhile
                known.is_gone(path)
                continue
            if offset < sent or held[:offset] != mesh[:offset]:
                raise AssertionError(f"{path}: {sent} bytes were acknowledged, {offset} are there")

    def may_fail(self, error):
        """Returns whether a job may fail with `error`: an earlier request has used its upload or deleted its model."""
        return "gone" in error

    def jobs_have_ended(self, client, known):
        jobs = client.json("GET", "/api/v1/jobs?limit=50")[1]["jobs"]
        known.made.update(job["model"] for job in jobs if job["state"] == "done")
        for job in jobs:
            if job["state"] == "failed" and not self.may_fail(job["error"]):
                raise AssertionError(f"a job failed: {job}")
            if job["state"] in ("failed", "cancelled") and job["model"] is not None:
                raise AssertionError(f"a job whose model was stored is not done: {job}")
        return all(job["state"] in ("done", "failed", "cancelled") for job in jobs)

    @staticmethod
    def nothing_is_lost(client, known):
        for model in known.made - known.deleted:
            if client.json("GET", "/api/v1/models/" + model)[0] != 200:
                raise AssertionError(f"model {model} is lost")
        for job in known.jobs:
            if client.json("GET", "/api/v1/jobs/" + job)[0] != 200:
                raise AssertionError(f"job {job} is lost")

    def models(self, client):
        """Returns the names of the objects that models name, or None if one of these names cannot be requested."""
        names = set()
        for model in client.json("GET", "/api/v1/models?drafts=true&limit=200")[1]["models"]:
            path = "/api/v1/models/" + model["id"]
            names.add(self.model(client, path))
            if model["public_max_level"] is not None and model["state"] == "published":
                client.bearer, bearer = {}, client.bearer
                names.add(self.model(client, path))
                client.bearer = bearer
            elif model["public_max_level"] is not None:
                return None  # the file with the public levels of a draft has no URL
        return names

    def model(self, client, path):
        status, manifest = client.json("GET", path + "/manifest")
        if status != 200:
            raise AssertionError(f"{path}/manifest: {status} {manifest}")
        named = manifest["sha256"]
        file = client.ask("GET", path + "/file.pmesh")[1]
        if hashlib.sha256(file).hexdigest() != named:
            raise AssertionError(f"{path} is not what its manifest says")
        if named not in self.verified:
            self.verify(file, path)
            self.verified.add(named)
        return named

    def verify(self, file, path):
        with tempfile.NamedTemporaryFile(suffix=".pmesh") as copy:
            copy.write(file)
            copy.flush()
            result = subprocess.run([str(self.binaries / "vitrine"), "verify", copy.name], capture_output=True, text=True, check=False)
            if result.returncode != 0:
                raise AssertionError(f"{path}: {result.stderr}")

    def stored(self):
        return {file.name for file in (self.data / "objects").rglob("*") if file.is_file()}

    def until_clean(self, client, names):
        """Requests a garbage collection by an update without changes. Returns whether only `names` remain."""
        models = client.json("GET", "/api/v1/models?drafts=true")[1]["models"]
        if models:
            client.json("PATCH", "/api/v1/models/" + models[0]["id"], {"title": models[0]["title"]})
        end = time.monotonic() + TIMEOUT
        while self.stored() != names and time.monotonic() < end:
            time.sleep(0.02)
        return self.stored() == names


def check_log(daemon):
    """Checks that the daemon logged no error before it was killed."""
    if faults := [line for line in daemon.printed if "event=error" in line or "terminate called" in line]:
        raise AssertionError("".join(faults))


def main():
    binaries = Path(sys.argv[1])
    kills = int(sys.argv[2]) if len(sys.argv) > 2 else 20
    seed = int(sys.argv[3]) if len(sys.argv) > 3 else random.SystemRandom().randrange(1 << 32)
    print(f"{kills} kills, seed {seed}", flush=True)
    dice, known = random.Random(seed), Known()
    with tempfile.TemporaryDirectory(prefix="vitrine-") as folder:
        data = Path(folder) / "data"
        data.mkdir()
        token = new_token(binaries, data)
        look = Look(binaries, data)
        for _ in range(kills):
            daemon = Daemon(binaries, data)
            try:
                look.at(Client(daemon, token), known)
                work = Work(daemon, token, random.Random(dice.random()), known)
                work.start()
                work.client.enough.wait(TIMEOUT)
                time.sleep(dice.uniform(0, LONGEST))
            except BaseException:  # otherwise the daemon would outlive this process
                daemon.kill()
                print("".join(daemon.printed[-20:]))
                raise
            daemon.kill()
            work.join()
            if work.fault:
                raise work.fault
            check_log(daemon)
        daemon = Daemon(binaries, data)
        try:
            look.at(Client(daemon, token), known)
        finally:
            code = daemon.stop()
        check_log(daemon)
        print(f"ok: {len(look.verified)} files verified, {len(known.made - known.deleted)} models kept, {len(known.uploads)} uploads open")
        return code if look.verified else "no model was made"


if __name__ == "__main__":
    sys.exit(main())
