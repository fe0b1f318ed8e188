// SPDX-License-Identifier: Apache-2.0
// The subcommands: each is declared in its own file and listed in commands().
#pragma once

#include <span>
#include <string_view>

#include "server/cli/arguments.h"
#include "server/cli/outcome.h"

namespace vitrine::cli {

struct Command {
  std::string_view name;
  std::string_view summary;
  std::span<const std::string_view> operands;
  std::span<const Flag> flags;  // --help is understood by all
  Outcome (*run)(const Arguments& arguments);
};

extern const Command kBuild, kInfo, kDecode, kVerify, kMeasure, kPublish, kFetch, kCalibrate, kScan,
    kReprocess, kMerge, kToken, kBackup, kRestore, kMigrate, kDoctor;

// Runs a whole command line (without the program's name). Prints the fault, returns the exit code.
int run(std::span<const std::string_view> words);

}  // namespace vitrine::cli
