#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Builds a mesh that needs more memory than the daemon's control group has. The job must fail, and the daemon must survive.

Usage: memory_limit.py BINARIES

Exits with 77, which ctest counts as skipped, if the user may not make a control group with a memory limit. If VITRINE_NO_SKIPS is
set, the test fails instead.
"""
import contextlib
import os
import sys
import tempfile
from pathlib import Path

from crash import check_log, torus
from daemon import Client, Daemon, new_token
from disk import is_served, job_of, upload

FAILED, SKIPPED = 1, 77
LIMIT = 60 << 20  # bytes that the daemon and its child processes may use together
GROUPS = ((Path("/sys/fs/cgroup/memory"), "memory.limit_in_bytes"), (Path("/sys/fs/cgroup"), "memory.max"))


def limited_group():
    """Returns the folder of a new control group with the memory limit, or None if it cannot be made."""
    for root, limit in GROUPS:
        group = root / f"vitrine-test-{os.getpid()}"
        with contextlib.suppress(OSError):
            group.mkdir()
            if (group / limit).exists():
                (group / limit).write_text(str(LIMIT), encoding="ascii")
                return group
            group.rmdir()
    return None


def run(binaries, data, group):
    token = new_token(binaries, data)
    # Posters would need more memory than the group has; without a cache, none are made before they are requested.
    daemon = Daemon(binaries, data, ["--export-cache", "0"], before=["sh", "-c", f'echo $$ >{group}/cgroup.procs; exec "$0" "$@"'])
    try:
        client = Client(daemon, token)
        model = job_of(client, upload(client, torus(30, 20))[1])["model"]
        job = job_of(client, upload(client, torus(600, 300))[1])
        assert job["state"] == "failed" and "memory ran out; raise MemoryMax" in job["error"], job
        assert is_served(client, model)
        assert job_of(client, upload(client, torus(20, 20))[1])["state"] == "done"
    finally:
        code = daemon.stop()
    assert code == 0, daemon.printed[-3:]
    check_log(daemon)


def main():
    group = limited_group()
    if not group:
        print("no control group with a limit of memory can be made")
        return FAILED if "VITRINE_NO_SKIPS" in os.environ else SKIPPED
    try:
        with tempfile.TemporaryDirectory(prefix="vitrine-") as folder:
            data = Path(folder) / "data"
            data.mkdir()
            run(Path(sys.argv[1]), data, group)
    finally:
        group.rmdir()
    print("ok")
    return 0


if __name__ == "__main__":
    sys.exit(main())
