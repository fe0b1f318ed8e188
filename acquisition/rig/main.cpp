// SPDX-License-Identifier: Apache-2.0
#include <csignal>
#include <string_view>
#include <vector>

#include "acquisition/rig/run.h"
#include "acquisition/rig_board/usb_board.h"
#include "codec/files/file_descriptor.h"

int main(int argc, char** argv) {
  vitrine::keep_standard_streams();
  vitrine::acquisition::rig::enter_testbed(argv);
  std::signal(SIGPIPE, SIG_IGN);
  const std::vector<std::string_view> words(argv + (argc > 0 ? 1 : 0), argv + argc);
  return vitrine::acquisition::rig::run(words);
}
