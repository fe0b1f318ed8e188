// SPDX-License-Identifier: Apache-2.0
// Results go to stdout, progress and faults to stderr.
#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

#include "server/cli/outcome.h"
#include "server/jobs/sandbox.h"

namespace vitrine::cli {

// Writes `text` and a line end to stdout. Fails where it cannot take them (a full disk).
Outcome print(std::string_view text);
Outcome print_json(const nlohmann::json& object);  // what is not UTF-8 in it is replaced

// Prints "vitrine: …" to stderr, where that takes it.
void print_fault(std::string_view message);

// A bar on stderr where that is a terminal, else nothing. Gone when destroyed.
class ProgressBar {
 public:
  ProgressBar();
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  ProgressReport report();  // valid as long as the bar

 private:
  void show(std::string_view stage, double fraction);

  const bool is_terminal_;
};

}  // namespace vitrine::cli
