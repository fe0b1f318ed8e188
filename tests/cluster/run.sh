#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# run.sh BINARIES: the cluster's test, on a loopback of its own and beside a simulated scanner.
set -euo pipefail
VITRINE_BIN=$(realpath "$1")
VITRINE_RIG=$(mktemp -d)
export VITRINE_BIN VITRINE_RIG
trap 'rm -rf "$VITRINE_RIG"' EXIT
"$VITRINE_BIN/vitrine-rig" --empty --private-network --write-config "$VITRINE_RIG/first.json" \
  --write-commands "$VITRINE_RIG/first.commands" -- node --test "$(dirname "$0")/cluster.test.mjs"
