// SPDX-License-Identifier: Apache-2.0
#include "server/log/write_whole.h"

#include <unistd.h>

#include <cerrno>

namespace vitrine::server {

void write_whole(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const auto written = ::write(descriptor, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

}  // namespace vitrine::server
