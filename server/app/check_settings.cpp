// SPDX-License-Identifier: Apache-2.0
#include "server/app/check_settings.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "codec/files/atomic_file.h"
#include "server/http/listening.h"
#include "server/jobs/open_scanners.h"
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

// Whether the file will be in the data folder, which the daemon creates at its first start.
bool is_in_new_folder(const fs::path& file, const fs::path& data) {
  std::error_code unknown;
  return !fs::exists(data, unknown) &&
         fs::weakly_canonical(file.parent_path(), unknown) == fs::weakly_canonical(data, unknown);
}

// Checks the data folder and the files that the daemon will write. If the data folder does not
// exist, checks the folder in which it would be created. The error (kIo) names the key and the
// path.
Expected<void> check_paths(const Settings& settings) {
  if (auto ok = named("data", check_installation(settings.data)); !ok) return ok;
  if (auto ok = named("store", check_place(place_of(settings))); !ok) return ok;
  for (const auto& [key, file] : {std::pair("port-file", settings.port_file),
                                  std::pair("admin-port-file", settings.admin_port_file)}) {
    if (file.empty() || is_in_new_folder(file, settings.data)) continue;
    if (auto ok = named(key, check_writable(file)); !ok) return ok;
  }
  if (settings.access_log.empty() || is_in_new_folder(settings.access_log, settings.data))
    return {};
  return named("access-log", check_log(settings.access_log));
}

// Opens the certificate and the key. Returns null if the settings do not enable TLS.
Expected<std::shared_ptr<LiveTls>> open_tls(const Settings& settings) {
  const TlsFiles files{settings.tls_certificate, settings.tls_key};
  if (files == TlsFiles{}) return nullptr;
  if (files.certificate.empty() || files.key.empty()) {
    return fail(ErrorCode::kBadInput,
                fmt::format("{} is set alone; set {}, too",
                            files.key.empty() ? "tls-certificate" : "tls-key",
                            files.key.empty() ? "tls-key" : "tls-certificate"));
  }
  return LiveTls::open(files);
}

}  // namespace

Unexpected of_admin(const Error& error) {
  return fail(error.code, "--admin-listen: " + error.message);
}

Expected<void> check_addresses(const Settings& settings) {
  if (settings.roles.serves) {
    if (auto usable = check_address(settings.listen); !usable) return usable;
  }
  const auto usable = check_address(settings.admin_listen);
  return usable ? Expected<void>{} : of_admin(usable.error());
}

Expected<std::shared_ptr<LiveTls>> check_files(const Settings& settings,
                                               std::span<const std::filesystem::path> scanners) {
  if (auto usable = check_paths(settings); !usable) return tl::unexpected(usable.error());
  if (const auto valid = open_scanners(scanners, {}); !valid) return tl::unexpected(valid.error());
  return open_tls(settings);
}

bool others_may_read(const std::filesystem::path& folder) {
  std::error_code unknown;
  const auto mode = std::filesystem::status(folder, unknown).permissions();
  return (mode & std::filesystem::perms::others_all) != std::filesystem::perms::none;
}

}  // namespace vitrine::server
