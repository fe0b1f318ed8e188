#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Lets allocations fail at random. Requests that need memory may fail or be cut off, but the daemon must keep serving.

Usage: memory.py BINARIES [ROUNDS]
"""
import http.client
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from crash import torus
from daemon import Client, Daemon, new_token
from disk import job_of, upload

REFUSED = 0.02  # share of all calls of malloc, calloc and realloc that fail


def calls(model):
    """Yields requests as (method, path, body, headers). They use different parts of the daemon."""
    path = f"/api/v1/models/{model}"
    order = {"Content-Type": "application/json"}
    stream = {"Connection": "Upgrade", "Upgrade": "websocket", "Sec-WebSocket-Version": "13",
              "Sec-WebSocket-Key": "dGhlIHNhbXBsZSBub25jZQ==", "Sec-WebSocket-Protocol": "pmesh.v1"}
    yield "GET", "/api/v1/models?q=torus", None, {}
    yield "GET", "/api/v1/models?limit=0&cursor=x", None, {}
    yield "GET", path + "/manifest", None, {}
    yield "GET", path + "/export.glb?triangles=500", None, {}
    yield "GET", path + "/poster.png", None, {}
    yield "GET", "/api/v1/openapi.json", None, {}
    yield "GET", "/nothing", None, {}
    yield "GET", path + "/stream?head=true", None, stream
    yield "PATCH", path, json.dumps({"title": "torus", "subject": "ring"}), order
    yield "PATCH", path, json.dumps({"faces": [[1], {"a": {"b": 2}}]}), order
    yield "POST", "/api/v1/models", json.dumps({"upload": "x", "metadata": {"title": "x"}}), order


def ask(daemon, token, call):
    """Sends a request and returns the status; 0 if the connection was cut."""
    method, path, body, fields = call
    connection = http.client.HTTPConnection("127.0.0.1", daemon.port, timeout=60)
    try:
        connection.request(method, path, body, {"Authorization": "Bearer " + token, **fields})
        return connection.getresponse().status
    except (OSError, http.client.HTTPException):
        return 0
    finally:
        connection.close()


def settled(daemon, token, call):
    """Repeats a request while it gets 503, for at most 5 s, and returns its status. After a failure to open a model, all requests
    for it fail for a tenth of a second."""
    end = time.monotonic() + 5
    while True:
        status = ask(daemon, token, call)
        if status != 503 or time.monotonic() > end:
            return status
        time.sleep(0.02)


def refuse_memory(daemon, control, token, model, rounds):
    """Sends requests while allocations fail. Returns how often each status occurred."""
    def fiu(command):
        subprocess.run(["fiu-ctrl", "-f", str(control), "-c", command, str(daemon.process.pid)], check=True, capture_output=True, timeout=20)

    seen = {}
    for _ in range(rounds):
        fiu(f"enable_random name=libc/mm/malloc,probability={REFUSED}")
        for call in calls(model):
            status = ask(daemon, token, call)
            seen[status] = seen.get(status, 0) + 1
            assert daemon.process.poll() is None, (call, daemon.process.returncode)
        fiu("disable name=libc/mm/malloc")
        for call in calls(model):
            status = settled(daemon, token, call)
            assert status in (101, 200, 400, 404, 422), (call, status, "once there is memory again")
    return dict(sorted(seen.items()))


def main():
    binaries, rounds = Path(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 30
    with tempfile.TemporaryDirectory(prefix="vitrine-") as folder:
        data, control = Path(folder) / "data", Path(folder) / "control"
        data.mkdir()
        token = new_token(binaries, data)
        daemon = Daemon(binaries, data, ["--request-rate", "0"], ["fiu-run", "-x", "-f", str(control)])
        try:
            client = Client(daemon, token)
            model = job_of(client, upload(client, torus(30, 20))[1], metadata={"title": "torus"})["model"]
            print("statuses while memory was refused:", refuse_memory(daemon, control, token, model, rounds))
        except BaseException:
            daemon.kill()
            print("".join(daemon.printed[-20:]))
            raise
        assert daemon.stop() == 0, daemon.printed[-3:]
    print("ok")


if __name__ == "__main__":
    main()
