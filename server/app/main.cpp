// SPDX-License-Identifier: Apache-2.0
#include <string_view>
#include <vector>

#include "codec/files/file_descriptor.h"
#include "server/app/daemon.h"
#include "server/sandbox/build_child.h"

extern char** environ;

int main(int argc, char** argv) {
  vitrine::keep_standard_streams();
  const std::vector<std::string_view> arguments(argv + 1, argv + argc);
  vitrine::server::become_build_child(arguments);
  std::vector<std::string_view> environment;
  for (char** entry = environ; *entry != nullptr; ++entry)
    environment.emplace_back(*entry);
  return vitrine::server::run_daemon(arguments, environment);
}
