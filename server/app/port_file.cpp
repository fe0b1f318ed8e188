// SPDX-License-Identifier: Apache-2.0
#include "server/app/host_system.h"

#include <fmt/format.h>

#include "codec/files/atomic_file.h"

namespace vitrine::server {

Expected<void> write_port_file(const std::filesystem::path& file, std::uint16_t port) {
  if (file.empty()) return {};
  const std::string text = fmt::format("{}\n", port);
  return write_file_atomically(file,
                               {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

}  // namespace vitrine::server
