// SPDX-License-Identifier: Apache-2.0
// The checks of `vitrine doctor`, and the findings that they return.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "server/store/installation.h"

namespace vitrine::server {

// kFail means that visitors cannot use the server or that data is at risk.
enum class Verdict { kOk, kWarn, kFail };

struct Finding {
  Verdict verdict = Verdict::kOk;
  std::string check;   // one word, such as "disk"
  std::string detail;  // what the check has observed
  std::string advice;  // the next step; empty if the check passed
};

using Findings = std::vector<Finding>;

// Checks the clock and the limit on open files.
Findings check_machine();

// Checks permissions, disk space, the catalogue and the files of all models. Changes nothing, but
// makes a temporary copy of the catalogue in the folder.
Findings check_data(const std::filesystem::path& data);

// Checks that the bucket and the database allow everything a daemon does, and that the files of all
// models exist. Writes a small object to the bucket and removes it again.
Findings check_services(const InstallationPlace& place);

// Reads every object that the catalogue names and checks its SHA-256, and checks the catalogue for
// damage. Returns one finding for each damaged object.
Findings check_integrity(const InstallationPlace& place);

// Requests `url` as a visitor does, through proxies. Checks certificate, clock, CORS, entity tags,
// ranges, caching and WebSocket. Also checks the scanners if `token` has at least the viewer role.
Findings check_server(const std::string& url, const std::string& token);

}  // namespace vitrine::server
