#!/bin/sh -eu
# SPDX-License-Identifier: Apache-2.0
# Calibrates a scanner, scans an object and publishes the model. Set URL to the server's address, T
# to the token of an operator, and SCANNER to the scanner's name.
ask() { curl -fsS -H "Authorization: Bearer $T" -H 'Content-Type: application/json' "$@"; }

# If an operator places the calibration target, confirm each pose with:
#   ask -X POST $URL/api/v1/jobs/$job/resume
job=$(ask $URL/api/v1/scanners/$SCANNER/calibrations -d '{"poses": 20}' | jq -r .job)
ask $URL/api/v1/jobs/$job/events                          # streams progress until the job ends
scan=$(ask $URL/api/v1/scans -d '{"scanner": "'$SCANNER'", "metadata": {"title": "Bust"}}' | jq -r .id)
ask $URL/api/v1/jobs/$(ask $URL/api/v1/scans/$scan | jq -r .job)/events
# The model is a draft. If the scan request has "publish": true, omit the next call.
model=$(ask $URL/api/v1/scans/$scan | jq -r .model)
ask -X POST $URL/api/v1/models/$model/publish
curl -fsS $URL/api/v1/models/$model                       # the public view
