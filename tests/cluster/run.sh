#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# run.sh BINARIES [TEST]: runs a test of the cluster (default: cluster.test.mjs) with its own loopback interface, and with
# a simulated scanner.
set -euo pipefail
VITRINE_BIN=$(realpath "$1")
test=${2:-cluster.test.mjs}
cd "$(dirname "$0")"
VITRINE_RIG=$(mktemp -d)
VITRINE_OBJECT=$(realpath ../models/demosthenes.obj)
export VITRINE_BIN VITRINE_RIG VITRINE_OBJECT
trap 'rm -rf "$VITRINE_RIG"' EXIT
"$VITRINE_BIN/vitrine-rig" --mesh "$VITRINE_OBJECT" --private-network --write-config "$VITRINE_RIG/first.json" \
  --write-commands "$VITRINE_RIG/first.commands" -- node --test "$test"
