// SPDX-License-Identifier: Apache-2.0
// Declares the subcommands of `vitrine`. Each subcommand has its own file; run.cpp lists them all.
#pragma once

#include <span>
#include <string_view>

#include "server/cli/support/arguments.h"
#include "server/cli/support/outcome.h"

namespace vitrine::server::cli {

struct Command {
  std::string_view name;
  std::string_view summary;       // one sentence, shown in the list of commands
  std::string_view details = {};  // further sentences for --help
  std::span<const std::string_view> operands = {};
  std::span<const Flag> flags;     // all flags except --help, which every command has
  std::string_view examples = {};  // command lines, shown by --help
  CommandOutcome (*run)(const Arguments& arguments);
};

extern const Command kBuild, kInfo, kDecode, kVerify, kMeasure, kPublish, kFetch, kCalibrate, kScan,
    kReprocess, kFuse, kToken, kBackup, kRestore, kRepair, kMigrate, kDoctor, kCompletion;

std::span<const Command* const> commands();  // in the order of the list that --help prints

// Runs a whole command line, given without the program's name. Prints the error, if any, and
// returns the exit code.
int run(std::span<const std::string_view> words);

}  // namespace vitrine::server::cli
