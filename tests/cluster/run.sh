#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# run.sh BINARIES: runs the cluster's test with its own loopback interface, and with a simulated scanner.
set -euo pipefail
VITRINE_BIN=$(realpath "$1")
cd "$(dirname "$0")"
VITRINE_RIG=$(mktemp -d)
VITRINE_OBJECT=$(realpath ../models/demosthenes.obj)
export VITRINE_BIN VITRINE_RIG VITRINE_OBJECT
trap 'rm -rf "$VITRINE_RIG"' EXIT
"$VITRINE_BIN/vitrine-rig" --mesh "$VITRINE_OBJECT" --private-network --write-config "$VITRINE_RIG/first.json" \
  --write-commands "$VITRINE_RIG/first.commands" -- node --test cluster.test.mjs
