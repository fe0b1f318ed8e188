#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Tests the object store of the compose file: it starts, stores an object of its user, and denies access to others. The
# test runs in its own network and PID namespaces, which end with it.
set -euo pipefail
if [[ -z ${RGW_DATA-} ]]; then
  RGW_DATA=$(mktemp -d)
  trap 'rm -rf "$RGW_DATA"' EXIT
  export RGW_DATA
  unshare --net --pid --fork --mount-proc "$0"
  exit
fi

ip link set lo up
export PATH=$PATH:/usr/sbin RGW_ACCESS_KEY=museum RGW_SECRET_KEY=secret RGW_BYTES=$((2 << 30))
start=$(dirname "$0")/../../deploy/container/rgw/start
object=http://127.0.0.1:7480/models/object
ask() {
  curl -fsS --aws-sigv4 aws:amz:default:s3 --user museum:secret -H 'x-amz-content-sha256: UNSIGNED-PAYLOAD' "$@" "$object"
}

coproc gateway { exec "$start" 2>"$RGW_DATA/log"; }
pid=$gateway_PID
until read -r line <&"${gateway[0]}" && [[ $line == "bucket 'models' at port 7480" ]]; do
  kill -0 $pid || { cat "$RGW_DATA/log" && exit 1; }
done
ask --upload-file "$start"
ask | cmp - "$start"
[[ $(curl -s -o /dev/null -w '%{http_code}' "$object") == 403 ]]
kill -TERM $pid
