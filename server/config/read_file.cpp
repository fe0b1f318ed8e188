// SPDX-License-Identifier: Apache-2.0
#include "server/config/read_file.h"

#include <fmt/core.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "server/config/command_line.h"

namespace vitrine::server {

Expected<std::string> read_config_file(const std::string& path) {
  std::ifstream file(path);
  int error = errno;
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored))
    error = EISDIR;  // open() succeeds for a folder, but read() would fail
  if (!file || error == EISDIR) {
    return fail(ErrorCode::kIo,
                fmt::format("cannot read {}: {}; check --config", path, std::strerror(error)));
  }
  return std::string(std::istreambuf_iterator<char>(file), {});
}

Expected<Settings> read_settings(const std::string& path,
                                 std::span<const std::string_view> environment) {
  const std::array<std::string_view, 2> arguments{"--config", path};
  const auto line = parse_command_line(arguments, environment, read_config_file);
  if (!line) return tl::unexpected(line.error());
  return line->settings;
}

}  // namespace vitrine::server
