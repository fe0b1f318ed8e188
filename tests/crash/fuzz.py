#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Sends mutated HTTP requests and WebSocket frames to the daemon.

The daemon must not end, must not answer with a status 5xx, and must not use more and more memory.

Usage: fuzz.py BINARIES [REQUESTS [FRAMES [SEED]]]

The requests are mutations of all calls of the OpenAPI document and of requests for some pages, with and without a token.
The frames are mutations of all messages of the stream protocol. Prints the random seed, how often each status occurred, and
how much memory the daemon used.
"""
import collections
import json
import os
import random
import re
import socket
import sys
import tempfile
import time
from pathlib import Path

from crash import torus
from daemon import Client, Daemon, new_token
from disk import job_of, upload
from mutations import mutated

TIMEOUT = 20  # seconds within which the daemon must end a connection or job, or close its descriptors
GROWTH = 4 << 20  # bytes by which the resident memory may grow after the first half of a long run
WARM = 20000  # least number of requests or frames of a long run; in shorter runs, caches and arenas still grow
COLD_GROWTH = 32 << 20  # bytes by which the resident memory may grow after the first half of a shorter run
ROUND = 1000  # number of requests or frames per round; a model that was deleted is made again before the next round
# With these, freed memory goes back to the system at once, so that the resident memory shows what the daemon holds.
HEAP = {"MALLOC_ARENA_MAX": "1", "MALLOC_MMAP_THRESHOLD_": "65536", "MALLOC_TRIM_THRESHOLD_": "65536"}
OPTIONS = ["--request-rate", "0", "--max-connections-per-address", "0", "--export-cache", "4000000", "--model-cache", "4000000",
           "--max-upload", "1000000"]
OEMBED_FORMAT = b"501"  # the status that oEmbed prescribes for an unknown format; no other 5xx may come
STATUS = re.compile(rb"HTTP/1\.1 (\d{3}) ")


def mutated_request(dice, seeds):
    """Returns a request mutated anywhere, or only in its target, a field or its body, so that it reaches the handlers."""
    part = dice.choice(["any", "target", "field", "body"])
    head, end, body = dice.choice(seeds).partition(b"\r\n\r\n")
    if part == "body" and body:
        content = mutated(dice, [body])
        return re.sub(rb"Content-Length: \d+", b"Content-Length: %d" % len(content), head) + end + content
    if part == "target":
        method, target, rest = head.split(b" ", 2)
        return b" ".join([method, re.sub(rb"[\0-\x20\x7f-\xff]", b"", mutated(dice, [target])) or b"/", rest]) + end + body
    if part == "field":
        fields = head.split(b"\r\n")
        at = dice.randrange(1, len(fields))
        name, colon, value = fields[at].partition(b": ")
        fields[at] = name + colon + re.sub(rb"[\0-\x1f\x7f]", b"", mutated(dice, [value]))
        return b"\r\n".join(fields) + end + body
    return mutated(dice, seeds)


def talk(port, content):
    """Sends `content` on a new connection and shuts down the sending side. Returns all bytes that the daemon sends until it closes."""
    with socket.create_connection(("127.0.0.1", port), TIMEOUT) as connection:
        answer = bytearray()
        try:
            connection.sendall(content)
            connection.shutdown(socket.SHUT_WR)
            while part := connection.recv(1 << 16):
                answer += part
        except TimeoutError:
            raise
        except OSError:  # the daemon may close the connection before it has read all of a bad request
            pass
        return bytes(answer)


class Requests:
    """Valid requests, as bytes. They refer to a model, a job and an upload that the daemon has."""

    BODIES = {
        "ModelOrder": {"upload": "UPLOAD", "publish": True, "metadata": {"title": "Torus", "subject": "ring"}, "bits": 12},
        "ModelChange": {"title": "Ring", "unit": "cm", "public_max_level": 1},
        "TokenOrder": {"role": "viewer", "name": "a reader", "expires": "2099-01-01T00:00:00Z"},
        "ScanOrder": {"scanner": "rig", "steps": 12, "metadata": {"title": "Scan"}},
        "CalibrationOrder": {"poses": 12}, "Jog": {"degrees": 30}, "LaserSwitch": {"on": True}, "Nothing": {},
        "ReprocessOrder": {"publish": True},
        "Notes": {"notes": [{"id": "a", "position": [1, 2, 3], "texts": {"en": {"title": "A", "text": "[b](https://c.example)"}},
                             "picture": "/x.png", "view": {"direction": [0, 0, 1], "zoom": 2}, "light": "raking,315", "section": "y,50"}]},
        "Tours": {"tours": [{"id": "t", "titles": {"en": "T"}, "steps": [{"note": "a", "seconds": 5}]}]},
    }
    VALUES = {"q": "ring", "limit": "5", "cursor": "eA", "drafts": "true", "triangles": "500", "error": "0.5", "bytes": "9000",
              "level": "1", "kbps": "800", "seconds": "2", "saveData": "on", "texture": "512", "width": "240", "from": "0", "maxwidth": "300",
              "maxheight": "200", "format": "json", "url": "http://localhost/models/MODEL", "verb": "ListRecords", "metadataPrefix": "lido",
              "identifier": "oai:localhost:MODEL", "until": "2099-01-01", "set": "rings", "resumptionToken": "eA", "lod": "msft",
              "compression": "draco", "collection": "rings", "sort": "title", "subject": "ring", "unit": "cm", "up": "z"}
    HARVESTS = ("verb=ListRecords&metadataPrefix=oai_dc&from=2020-01-01&until=2099-01-01", "verb=ListIdentifiers&metadataPrefix=edm&set=rings",
                "verb=GetRecord&metadataPrefix=lido&identifier=oai:localhost:MODEL", "verb=Identify", "verb=ListSets&resumptionToken=eA")
    PAGES = ("/", "/models/MODEL", "/collections/rings", "/scans/MODEL", "/sitemap.xml", "/robots.txt", "/console", "/docs")

    def __init__(self, document, token, names):
        self.bearer, self.names, self.components = f"Authorization: Bearer {token}\r\n", names, document["components"]
        self.all = [self.filled(f"{method} {path} HTTP/1.1\r\nHost: localhost\r\n", "") for method, path in
                    (*(("GET", page) for page in self.PAGES), ("HEAD", "/docs"), ("OPTIONS", "/api/v1/models"))]
        for path, calls in document["paths"].items():
            for method, call in calls.items():
                for form in ("ply", "glb") if "{format}" in path else ("",):
                    self.all += self.of(method.upper(), path.replace("{format}", form), call)

    def of(self, method, path, call):
        """Returns requests for one call: without a query, with each query parameter, and without a token but with further fields."""
        fields = "Host: localhost\r\nTus-Resumable: 1.0.0\r\nUpload-Length: 900\r\nUpload-Offset: 0\r\nIdempotency-Key: k\r\n"
        kind, schema = next(iter(call.get("requestBody", {}).get("content", {"": {}}).items()))
        bodies = [json.dumps(self.BODIES[schema["schema"]["$ref"].rsplit("/", 1)[1]])] if kind == "application/json" else \
            self.HARVESTS if kind == "application/x-www-form-urlencoded" else [""]
        fields += f"Content-Type: {kind}\r\n" if kind else ""
        path = path.replace("{name}", "rig").replace("{number}", "1").replace("{sha256}", "CHUNK")
        queries = [""] + [f"?{name}={self.VALUES[name]}" for name in self.queried(call) if name in self.VALUES]
        queries += ["?" + harvest for harvest in self.HARVESTS if method == "GET" and path.endswith("/oai")]
        thing = {"jobs": "JOB", "uploads": "UPLOAD"}.get(path.split("/")[3], "MODEL")
        head = f"{method} {path.replace('{id}', thing)}"
        hides_the_model = thing == "MODEL" and (method == "DELETE" or path.endswith("/unpublish"))
        bearer = "" if hides_the_model else self.bearer  # without a model, most later requests would get 404
        requests = [self.filled(f"{head}{query} HTTP/1.1\r\n{fields}{bearer}", body) for query in queries for body in bodies]
        for more in ("", "Range: bytes=5-9,20-29\r\n", 'If-None-Match: "x", W/"y"\r\n', "Accept-Encoding: gzip;q=0.5, br\r\n",
                     "X-Forwarded-For: 10.0.0.1, 10.0.0.2\r\nForwarded: for=1.2.3.4;proto=https\r\nOrigin: http://other.example\r\n"):
            requests += [self.filled(f"{head} HTTP/1.1\r\n{fields}{more}", body) for body in bodies]
        return requests

    def queried(self, call):
        parameters = [self.components["parameters"][p["$ref"].rsplit("/", 1)[1]] if "$ref" in p else p for p in call.get("parameters", [])]
        return [parameter["name"] for parameter in parameters if parameter["in"] == "query"]

    def filled(self, head, body):
        for word, name in self.names.items():
            head, body = head.replace(word, name), body.replace(word, name)
        return f"{head}Content-Length: {len(body)}\r\n\r\n{body}".encode()


def frame(dice, payload, kind=1, mask=0x80):
    """Returns a WebSocket frame as a client sends it ([RFC6455] section 5.2)."""
    length = len(payload)
    sized = bytes([mask | length]) if length < 126 else bytes([mask | 126]) + length.to_bytes(2, "big") if length < 1 << 16 else \
        bytes([mask | 127]) + length.to_bytes(8, "big")
    key = dice.randbytes(4)
    return bytes([0x80 | kind]) + sized + key + bytes(byte ^ key[i & 3] for i, byte in enumerate(payload))


def messages(model):
    camera = [1.0 if i % 5 == 0 else 0.0 for i in range(16)]
    view = {"camera": camera, "fov": 45, "width": 800, "height": 600, "pixels": 1, "bytes": 100000}
    wants = [{"triangles": 500}, {"bytes": 9000, "turn": 3}, {"level": 2}, {"error": 0.01}, {"seconds": 0.01}, {"view": view}]
    others = [{"type": "have", "chunks": [[0, 1], [3, 3]]}, {"type": "ack", "bytes": 16384}, {"type": "pause"}, {"type": "resume"},
              {"type": "open", "model": 1, "id": model, "head": True}, {"type": "close", "model": 1}]
    return [json.dumps(message).encode() for message in [{"type": "want", **want} for want in wants] + others]


class Attack:
    """Runs a daemon that has a model, a job and an upload, and sends mutated requests and frames to it."""

    def __init__(self, binaries, data, dice):
        self.dice, self.data, self.binaries, self.seen = dice, data, binaries, collections.Counter()
        self.model, self.token = None, new_token(binaries, data, "admin")
        self.daemon = Daemon(binaries, data, OPTIONS)

    def client(self):
        """Returns a client with a valid token. Makes a new token if a request has removed the last one."""
        if Client(self.daemon, self.token).json("GET", "/api/v1/models")[0] == 401:
            self.token = new_token(self.binaries, self.data, "admin")
        return Client(self.daemon, self.token)

    def make(self):
        """Publishes a model if there is none, and makes the valid requests and messages, which contain its ID."""
        client = self.client()
        if not self.model or not self.is_public(client):
            job = job_of(client, upload(client, torus(40, 24))[1], metadata={"title": "Torus", "collection": "rings"})
            self.model, self.job = job["model"], job["id"]
        manifest = client.json("GET", f"/api/v1/models/{self.model}/manifest")[1]
        names = {"MODEL": self.model, "JOB": self.job, "UPLOAD": self.an_upload(client), "CHUNK": manifest["chunks"][-1]["sha256"]}
        document = client.json("GET", "/api/v1/openapi.json")[1]
        client.connection.close()
        self.requests, self.messages = Requests(document, self.token, names).all, messages(self.model)

    def warm(self):
        """Sends all GET requests without mutations, so that caches and thread arenas are filled before memory is measured."""
        for request in self.requests:
            if request.startswith(b"GET"):
                talk(self.daemon.port, request)

    def is_public(self, client):
        client.bearer, bearer = {}, client.bearer
        status = client.json("GET", f"/api/v1/models/{self.model}")[0]
        client.bearer = bearer
        return status == 200

    def an_upload(self, client):
        for open_upload in client.json("GET", "/api/v1/uploads?limit=50")[1]["uploads"]:
            client.tus("DELETE", "/api/v1/uploads/" + open_upload["id"])
        return upload(client, torus(10, 8))[1].rsplit("/", 1)[1]

    def send_requests(self, count):
        """Sends `count` mutated requests, up to three on each connection."""
        while count > 0:
            some = [mutated_request(self.dice, self.requests) for _ in range(min(count, self.dice.choice([1, 1, 3])))]
            self.seen.update(STATUS.findall(talk(self.daemon.port, b"".join(some))))
            count -= len(some)

    def send_frames(self, count):
        """Sends `count` mutated frames, each after a handshake and up to two valid messages."""
        upgrade = (f"GET /api/v1/models/{self.model}/stream?head=true HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\n"
                   "Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
                   "Sec-WebSocket-Protocol: pmesh.v1\r\n\r\n").encode()
        for _ in range(count):
            before = [frame(self.dice, self.dice.choice(self.messages)) for _ in range(self.dice.randint(0, 2))]
            self.seen.update(STATUS.findall(talk(self.daemon.port, upgrade + b"".join(before) + self.mutated_frame())[:20]))

    def mutated_frame(self):
        if self.dice.random() < 0.6:  # a valid frame with a mutated message
            return frame(self.dice, mutated(self.dice, self.messages), self.dice.choice([1, 1, 1, 1, 2, 8, 9]))
        return mutated(self.dice, [frame(self.dice, message, kind, mask) for message in self.messages[:3]
                                   for kind in range(16) for mask in (0x80, 0)])

    def check(self):
        assert self.daemon.process.poll() is None, f"the daemon ended with {self.daemon.process.returncode}"
        assert not [status for status in self.seen if status[:1] == b"5" and status != OEMBED_FORMAT], self.seen
        if faults := [line for line in self.daemon.printed if "event=error" in line or "terminate called" in line]:
            raise AssertionError("".join(faults[:5]))

    def resident(self, most=0):
        """Waits until all jobs have ended, because they need memory, and at most TIMEOUT until posters and exports in the making
        have ended, too, so that the daemon's resident memory is at most `most` bytes. Returns it in bytes."""
        client, end = self.client(), time.monotonic() + TIMEOUT
        while any(job["ended"] is None for job in client.json("GET", "/api/v1/jobs")[1]["jobs"]):
            assert time.monotonic() < end, "a job does not end"
            time.sleep(0.02)
        client.connection.close()
        while self.daemon.resident() > most > 0 and time.monotonic() < end:
            time.sleep(0.02)
        return self.daemon.resident()

    def until_idle(self, most):
        """Waits until the daemon has at most `most` open descriptors."""
        end = time.monotonic() + TIMEOUT
        while len(self.daemon.descriptors()) > most:
            assert time.monotonic() < end, f"{most} descriptors were open, now {sorted(self.daemon.descriptors())}"
            time.sleep(0.02)

    def run(self, send, count, name):
        """Sends `count` mutations in rounds. Checks how much the memory grows in the second half."""
        before, half = len(self.daemon.descriptors()), None
        for sent in range(0, count, ROUND):
            self.make()
            send(min(ROUND, count - sent))
            self.check()
            if half is None and 2 * (sent + ROUND) >= count:
                half = self.resident()
        self.until_idle(before + 4)
        most = half + (GROWTH if count >= WARM else COLD_GROWTH)
        last = self.resident(most)
        print(f"{count} {name}: {dict(sorted(self.seen.items()))}, {before} and {len(self.daemon.descriptors())} descriptors, "
              f"{half / 1e6:.1f} and {last / 1e6:.1f} MB at the half and the end", flush=True)
        assert last <= most, "the memory grows"
        self.seen.clear()


def main():
    binaries = Path(sys.argv[1])
    requests, frames = (int(sys.argv[i]) if len(sys.argv) > i else few for i, few in ((2, 2000), (3, 1000)))
    seed = int(sys.argv[4]) if len(sys.argv) > 4 else random.SystemRandom().randrange(1 << 32)
    print(f"seed {seed}", flush=True)
    os.environ.update(HEAP)  # the daemon inherits them
    with tempfile.TemporaryDirectory(prefix="vitrine-") as folder:
        data = Path(folder) / "data"
        data.mkdir()
        attack = Attack(binaries, data, random.Random(seed))
        try:
            attack.make()
            attack.warm()
            attack.run(attack.send_requests, requests, "requests")
            attack.run(attack.send_frames, frames, "frames")
            attack.make()
        except BaseException:
            attack.daemon.kill()
            print("".join(attack.daemon.printed[-20:]))
            raise
        assert attack.daemon.stop() == 0, attack.daemon.printed[-3:]
    print("ok")


if __name__ == "__main__":
    main()
