#!/bin/sh -eu
# SPDX-License-Identifier: Apache-2.0
# From an empty table to a public model. URL is the server's, T an operator's token, SCANNER a name.
ask() { curl -fsS -H "Authorization: Bearer $T" -H 'Content-Type: application/json' "$@"; }

# Where somebody has to place the target, each pose waits for: ask -X POST $URL/api/v1/jobs/$job/resume
job=$(ask $URL/api/v1/scanners/$SCANNER/calibrations -d '{"poses": 20}' | jq -r .job)
ask $URL/api/v1/jobs/$job/events                          # progress, as it comes, to the job's end
scan=$(ask $URL/api/v1/scans -d '{"scanner": "'$SCANNER'", "metadata": {"title": "Bust"}}' | jq -r .id)
ask $URL/api/v1/jobs/$(ask $URL/api/v1/scans/$scan | jq -r .job)/events
model=$(ask $URL/api/v1/scans/$scan | jq -r .model)       # a draft; "publish": true in the order spares what follows
ask -X POST $URL/api/v1/models/$model/publish
curl -fsS $URL/api/v1/models/$model                       # as visitors see it
