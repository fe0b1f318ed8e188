// SPDX-License-Identifier: Apache-2.0
// Checks and writes the output files of a command, one of which may be standard output.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <span>
#include <string>

#include "codec/core/expected.h"
#include "server/cli/support/arguments.h"
#include "server/cli/support/input.h"

namespace vitrine::server::cli {

inline constexpr Flag kForceFlag = {"--force", "", "replace output files that exist"};

// Checks that `out` can be written. Call this before long work. Fails (kIo) if the folder cannot be
// written to, and (kBadInput) if the file exists, unless the user gave kForceFlag.
Expected<void> check_output(const Arguments& arguments, const std::filesystem::path& out);

// Like check_output(), but `out` may be kStandardStream. Fails (kBadInput) if standard output is a
// terminal.
Expected<void> check_output_or_stdout(const Arguments& arguments, const std::string& out);

// Writes the file `out` atomically, or writes to standard output if `out` is kStandardStream.
CommandOutcome write_output(const std::string& out, std::span<const std::uint8_t> bytes);

// Returns the stream on which a command reports its result after writing `out`: stdout, or stderr
// if the file itself was written to stdout.
std::FILE* result_stream(const std::string& out);

}  // namespace vitrine::server::cli
