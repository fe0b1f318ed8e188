// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace vitrine {

enum class Verdict { kOk, kWarn, kFail };  // kFail: visitors or data suffer

// What a check has found.
struct Finding {
  Verdict verdict = Verdict::kOk;
  std::string check;   // a word: "disk"
  std::string detail;  // what was seen
  std::string advice;  // what to do; empty where all is well
};

using Findings = std::vector<Finding>;

}  // namespace vitrine
