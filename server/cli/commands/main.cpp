// SPDX-License-Identifier: Apache-2.0
#include <csignal>
#include <string_view>
#include <vector>

#include "codec/files/file_descriptor.h"
#include "server/cli/commands/command.h"

int main(int argc, char** argv) {
  vitrine::keep_standard_streams();
  // Ignores SIGPIPE, so that a command whose output pipe is closed can still switch off its
  // devices.
  std::signal(SIGPIPE, SIG_IGN);
  const std::vector<std::string_view> words(argv + (argc > 0 ? 1 : 0), argv + argc);
  return vitrine::server::cli::run(words);
}
