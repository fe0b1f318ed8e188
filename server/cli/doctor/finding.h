// SPDX-License-Identifier: Apache-2.0
// The result of one check of `vitrine doctor`.
#pragma once

#include <string>
#include <vector>

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

}  // namespace vitrine::server
