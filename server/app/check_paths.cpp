// SPDX-License-Identifier: Apache-2.0
#include "server/app/check_paths.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "codec/files/atomic_file.h"
#include "server/jobs/place_of.h"

namespace vitrine::server {
namespace {

namespace fs = std::filesystem;

Expected<void> named(std::string_view key, const Expected<void>& checked) {
  if (checked) return {};
  return fail(checked.error().code, fmt::format("{}: {}", key, checked.error().message));
}

// Checks that the access log can be written, even if it is a pipe or a terminal.
Expected<void> check_log(const fs::path& log) {
  std::error_code unknown;
  if (log == "-") return {};
  if (!fs::exists(log, unknown) || fs::is_directory(log, unknown)) return check_writable(log);
  if (::access(log.c_str(), W_OK) == 0) return {};
  return fail(ErrorCode::kIo, fmt::format("cannot write {}: {}; {}", log.string(),
                                          std::strerror(errno), next_step(errno)));
}

}  // namespace

Expected<void> check_paths(const Settings& settings) {
  if (auto ok = named("data", check_installation(settings.data)); !ok) return ok;
  if (auto ok = named("store", check_place(place_of(settings))); !ok) return ok;
  for (const auto& [key, file] : {std::pair("port-file", settings.port_file),
                                  std::pair("admin-port-file", settings.admin_port_file)}) {
    if (file.empty()) continue;
    if (auto ok = named(key, check_writable(file)); !ok) return ok;
  }
  if (settings.access_log.empty()) return {};
  return named("access-log", check_log(settings.access_log));
}

bool others_may_read(const std::filesystem::path& folder) {
  std::error_code unknown;
  const auto mode = std::filesystem::status(folder, unknown).permissions();
  return (mode & std::filesystem::perms::others_all) != std::filesystem::perms::none;
}

}  // namespace vitrine::server
