// SPDX-License-Identifier: Apache-2.0
#include <csignal>
#include <string_view>
#include <vector>

#include "codec/files/file_descriptor.h"
#include "server/cli/command.h"

int main(int argc, char** argv) {
  vitrine::keep_standard_streams();
  std::signal(SIGPIPE, SIG_IGN);  // a closed pipe ends no command before its devices are off
  const std::vector<std::string_view> words(argv + (argc > 0 ? 1 : 0), argv + argc);
  return vitrine::cli::run(words);
}
