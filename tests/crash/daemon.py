# SPDX-License-Identifier: Apache-2.0
"""The daemon as a process that can be killed, and an HTTP client for it."""
import contextlib
import http.client
import json
import os
import re
import signal
import subprocess
import threading
from pathlib import Path


class Gone(Exception):
    """The daemon does not respond: it was killed."""


class Ended(Exception):
    """The daemon ended before it served: `code` is its exit code, negative after a signal, `text` what it printed."""

    def __init__(self, code, text):
        super().__init__(f"the daemon ended with {code}: {text}")
        self.code, self.text = code, text


class Daemon:
    def __init__(self, binaries, data, options=(), before=()):
        command = [*before, str(binaries / "vitrined"), "--data", str(data), "--listen", "127.0.0.1:0",
                   "--admin-listen", "127.0.0.1:0", "--access-log", "", "--threads", "2", "--collect-after", "0", "--disk-reserve", "0", *options]
        self.process = subprocess.Popen(command, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True, errors="replace",
                                        env={k: v for k, v in os.environ.items() if not k.startswith("VITRINE_")})
        self.printed = []
        self.port = None
        while self.port is None:
            line = self.process.stderr.readline()
            self.printed.append(line)
            if not line:
                raise Ended(self.process.wait(), "".join(self.printed))
            if "listening on http://" in line and "admin" not in line:
                self.port = int(line.rsplit(":", 1)[1].split('"')[0].strip())
        self.reader = threading.Thread(target=lambda: self.printed.extend(self.process.stderr))
        self.reader.start()

    def resident(self):
        """Returns the daemon's resident memory in bytes."""
        status = Path(f"/proc/{self.process.pid}/status").read_text(encoding="ascii")
        return int(re.search(r"VmRSS:\s+(\d+)", status)[1]) << 10

    def descriptors(self):
        """Returns what each open descriptor of the daemon refers to, except undeleted model files, which the daemon caches."""
        found = []
        for link in Path(f"/proc/{self.process.pid}/fd").iterdir():
            with contextlib.suppress(FileNotFoundError):  # the daemon has closed the descriptor meanwhile
                found.append(os.readlink(link))
        return [name for name in found if "/objects/" not in name or "(deleted)" in name]

    def kill(self):
        self.process.send_signal(signal.SIGKILL)
        self.end()

    def stop(self):
        self.process.send_signal(signal.SIGTERM)
        self.end()
        return self.process.returncode

    def end(self):
        self.process.wait()
        self.reader.join()
        self.process.stderr.close()


class Client:
    """A client with one connection. Raises Gone if the connection breaks.

    Sets `enough` when it sends request number `number`."""

    def __init__(self, daemon, token, number=0):
        self.left, self.enough = number, threading.Event()
        self.connection = http.client.HTTPConnection("127.0.0.1", daemon.port, timeout=60)
        self.bearer = {"Authorization": "Bearer " + token}

    def ask(self, method, path, body=None, headers=None):
        self.left -= 1
        if self.left == 0:
            self.enough.set()
        try:
            self.connection.request(method, path, body=body, headers={**self.bearer, **(headers or {})})
            answer = self.connection.getresponse()
            return answer, answer.read()
        except (OSError, http.client.HTTPException) as fault:
            self.connection.close()
            raise Gone from fault

    def json(self, method, path, body=None):
        headers = {"Content-Type": "application/json"} if body is not None else {}
        answer, text = self.ask(method, path, None if body is None else json.dumps(body), headers)
        return answer.status, json.loads(text) if text else {}

    def tus(self, method, path, body=None, **headers):
        fields = {"Tus-Resumable": "1.0.0", **{k.replace("_", "-"): str(v) for k, v in headers.items()}}
        if method == "PATCH":
            fields["Content-Type"] = "application/offset+octet-stream"
        return self.ask(method, path, body, fields)[0]


def new_token(binaries, data, role="operator"):
    words = [str(binaries / "vitrine"), "token", "create", "--role", role, "--data", str(data), "--json"]
    return json.loads(subprocess.run(words, check=True, capture_output=True, text=True).stdout)["token"]
