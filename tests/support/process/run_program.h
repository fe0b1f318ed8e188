// SPDX-License-Identifier: Apache-2.0
// Runs a program as a user would, and returns its output.
#pragma once

#include <string>
#include <vector>

namespace vitrine::test {

struct ProgramResult {
  int exit_code = -1;  // -1 if a signal ended the program
  std::string output;  // stdout
  std::string errors;  // stderr
};

// `words` are the program and its arguments. The program's standard input is empty.
ProgramResult run_program(const std::vector<std::string>& words);

}  // namespace vitrine::test
