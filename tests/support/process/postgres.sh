#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# postgres.sh FOLDER: runs a PostgreSQL server on a free port of 127.0.0.1, never as root. Prints
# the port once the server responds. Then executes commands from standard input and replies to each
# with a line. The commands are create NAME, stop, start, kill (all processes) and kill-backend (one
# process that serves a client). Ends at the end of the input.
set -euo pipefail
cd "$1"
binaries=/usr/lib/postgresql/15/bin
as_owner=()
if ((EUID == 0)); then
  as_owner=(setpriv --reuid=postgres --regid=postgres --clear-groups)
  chown postgres:postgres .
fi
export HOME=$PWD PGPASSWORD=a-secret LC_ALL=C.UTF-8

free_port() {
  local lowest port
  read -r lowest _ </proc/sys/net/ipv4/ip_local_port_range
  for port in $(shuf -i "$((lowest - 8000))-$((lowest - 1))" -n 50); do
    (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null || break
  done
  echo "$port"
}
port=$(free_port)

control() {
  "${as_owner[@]}" "$binaries/pg_ctl" -D "$PWD/data" -l "$PWD/log" -w -t 60 "$@" </dev/null >>control 2>&1
}
stop() { control -m fast stop || true; }
start() {
  # The data is deleted after the test, so nothing needs to reach the disk.
  control -o "-p $port -h 127.0.0.1 -k '' -c fsync=off -c full_page_writes=off -c shared_buffers=32MB" start
}

kill_all() {
  local postmaster processes
  postmaster=$(head -n 1 data/postmaster.pid)
  mapfile -t processes < <(echo "$postmaster"; pgrep -P "$postmaster")
  kill -9 "${processes[@]}"
  while kill -0 "${processes[@]}" 2>/dev/null; do sleep 0.05; done
}
kill_backend() {
  kill -9 "$("$binaries/psql" -h 127.0.0.1 -p "$port" -U museum -XAtq postgres -c \
    "SELECT pid FROM pg_stat_activity WHERE backend_type = 'client backend' AND datname = 'museum' LIMIT 1")"
}

echo "$PGPASSWORD" >secret
[[ ${as_owner[*]} ]] && chown postgres secret
"${as_owner[@]}" "$binaries/initdb" -D "$PWD/data" -U museum -A scram-sha-256 --pwfile=secret -N \
  -E UTF8 </dev/null >init 2>&1
trap stop EXIT
start
echo "$port"
while read -r command name; do
  case $command in
    create) "$binaries/createdb" -h 127.0.0.1 -p "$port" -U museum "$name" ;;
    stop) stop ;;
    start) start ;;
    kill) kill_all ;;
    kill-backend) kill_backend ;;
  esac
  echo "done"
done
