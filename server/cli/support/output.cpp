// SPDX-License-Identifier: Apache-2.0
#include "server/cli/support/output.h"

#include <fmt/core.h>
#include <unistd.h>

#include "codec/files/atomic_file.h"
#include "server/cli/support/console.h"

namespace vitrine::server::cli {

Expected<void> check_output(const Arguments& arguments, const std::filesystem::path& out) {
  if (auto writable = check_writable(out); !writable) return writable;
  std::error_code unknown;  // ignored: writing the file will report the error
  if (arguments.has(kForceFlag.name) || !std::filesystem::exists(out, unknown)) return {};
  return fail(ErrorCode::kBadInput,
              fmt::format("{} exists; choose another name, or replace it with {}", out.string(),
                          kForceFlag.name));
}

Expected<void> check_output_or_stdout(const Arguments& arguments, const std::string& out) {
  if (out != kStandardStream) return check_output(arguments, out);
  if (::isatty(STDOUT_FILENO) == 0) return {};
  return fail(ErrorCode::kBadInput,
              "standard output is a terminal; send it to a file or to another program");
}

CommandOutcome write_output(const std::string& out, std::span<const std::uint8_t> bytes) {
  if (out == kStandardStream) return print_bytes(bytes);
  if (const auto written = write_file_atomically(out, bytes); !written)
    return failed(written.error());
  return {};
}

std::FILE* result_stream(const std::string& out) {
  return out == kStandardStream ? stderr : stdout;
}

}  // namespace vitrine::server::cli
