#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Damages the catalogue page by page. The daemon may refuse to start or serve, but must neither crash nor send wrong bytes.

Usage: pages.py BINARIES

For each page of the SQLite file, makes two damaged copies: one with all bits of the page inverted, one with a random bit
inverted. With each copy, every model file that the daemon sends must be the right one, and no signal may end the daemon.
`vitrine doctor --scrub` must find each inverted page. Prints the random seed.
"""
import collections
import hashlib
import json
import random
import shutil
import sqlite3
import subprocess
import sys
import tempfile
from pathlib import Path

from crash import torus
from daemon import Client, Daemon, Ended, Gone, new_token
from disk import job_of, upload

MODELS = 3


def make(binaries, data):
    """Publishes models and stops the daemon. Returns the models, each with the SHA-256 of its file, and a token."""
    token = new_token(binaries, data)
    daemon = Daemon(binaries, data)
    client, files = Client(daemon, token), {}
    for number in range(MODELS):
        model = job_of(client, upload(client, torus(20 + number, 12))[1], metadata={"title": f"Torus {number}"})["model"]
        files[model] = hashlib.sha256(client.ask("GET", f"/api/v1/models/{model}/file.pmesh")[1]).hexdigest()
    assert daemon.stop() == 0
    return files, token


def compact(catalogue):
    """Removes unused pages, because damage to them has no effect, and merges the WAL. Returns the size of a page in bytes."""
    database = sqlite3.connect(catalogue)
    database.execute("VACUUM")
    database.execute("PRAGMA wal_checkpoint(TRUNCATE)")
    size, = database.execute("PRAGMA page_size").fetchone()
    database.close()
    return size


def invert(content, page, size, _):
    begin = page * size
    return content[:begin] + bytes(byte ^ 0xFF for byte in content[begin:begin + size]) + content[begin + size:]


def flip_bit(content, page, size, dice):
    at = page * size + dice.randrange(size)
    return content[:at] + bytes([content[at] ^ 1 << dice.randrange(8)]) + content[at + 1:]


def visit(daemon, token, files):
    """Sends requests that read the catalogue, and one that changes it. Returns whether all models are served."""
    client, visitor, served = Client(daemon, token), Client(daemon, ""), 0
    visitor.bearer = {}
    for path in ("/api/v1/models?drafts=true&limit=50&q=torus", "/api/v1/models", "/api/v1/jobs", "/api/v1/tokens"):
        client.ask("GET", path)
    for model, sha256 in files.items():
        for caller in (client, visitor):
            answer, body = caller.ask("GET", f"/api/v1/models/{model}/file.pmesh")
            assert answer.status != 200 or hashlib.sha256(body).hexdigest() == sha256, f"model {model} gets another file"
            served += answer.status == 200
    client.json("PATCH", f"/api/v1/models/{next(iter(files))}", {"title": "Ring"})
    assert client.ask("GET", "/api/v1/openapi.json")[0].status == 200
    return served == 2 * len(files)


def refusal(code, text):
    says_what_to_do = any(word in text for word in ("restore a backup", "newer version", "readonly database"))
    assert code > 0 and "catalogue" in text and says_what_to_do, f"the daemon ended with {code}: {text}"
    return "refuses"


def outcome(binaries, data, token, files):
    """Starts the daemon on damaged data. Returns one word that describes its reaction."""
    try:
        daemon = Daemon(binaries, data)
    except Ended as ended:
        return refusal(ended.code, ended.text)
    try:
        all_served = visit(daemon, token, files)
    except Gone:  # the daemon may end after it has opened its port, but before it serves
        daemon.end()
        return refusal(daemon.process.returncode, daemon.printed[-1])
    except BaseException:
        daemon.kill()
        raise
    assert daemon.stop() == 0, daemon.printed[-3:]
    return "serves all" if all_served else "serves some"


def doctor_is_content(binaries, data):
    words = [str(binaries / "vitrine"), "doctor", "--data", str(data), "--scrub", "--json"]
    result = subprocess.run(words, capture_output=True, text=True, check=False)
    assert result.returncode in (0, 1), result
    checks = json.loads(result.stdout)["checks"]
    return all(check["verdict"] != "fail" for check in checks if check["check"] in ("catalogue", "integrity"))


def main():
    binaries, seed = Path(sys.argv[1]), random.SystemRandom().randrange(1 << 32)
    dice, seen = random.Random(seed), collections.Counter()
    print(f"seed {seed}", flush=True)
    with tempfile.TemporaryDirectory(prefix="vitrine-") as folder:
        whole, data = Path(folder) / "whole", Path(folder) / "data"
        whole.mkdir()
        files, token = make(binaries, whole)
        size = compact(whole / "catalogue.sqlite")
        content = (whole / "catalogue.sqlite").read_bytes()
        assert doctor_is_content(binaries, whole)
        for page in range(len(content) // size):
            for damage in (invert, flip_bit):
                shutil.copytree(whole, data)
                (data / "catalogue.sqlite").write_bytes(damage(content, page, size, dice))
                content_doctor = doctor_is_content(binaries, data)
                assert damage is flip_bit or not content_doctor, f"doctor does not see that page {page} is inverted"
                word = outcome(binaries, data, token, files)
                seen[f"{damage.__name__}: {word}, doctor {'content' if content_doctor else 'names it'}"] += 1
                shutil.rmtree(data)
    for word, count in sorted(seen.items()):
        print(f"{count:4} {word}")
    print("ok")


if __name__ == "__main__":
    main()
