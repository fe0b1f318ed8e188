// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/open_scanners.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>

#include "acquisition/session/open_scanner.h"
#include "server/jobs/fenced_devices.h"
#include "server/jobs/session_backend.h"

namespace vitrine::server {
namespace {

constexpr std::size_t kMaxName = 32;

bool may_be_in_a_path(char c) {
  return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-';
}

Expected<void> check_name(const std::string& name, const std::filesystem::path& config) {
  if (!name.empty() && name.size() <= kMaxName && std::ranges::all_of(name, may_be_in_a_path))
    return {};
  return fail(ErrorCode::kBadInput,
              fmt::format("{}: the name '{}' is not 1 to {} of a-z, 0-9 and -; give another",
                          config.string(), name, kMaxName));
}

}  // namespace

Expected<std::vector<std::unique_ptr<ScannerBackend>>> open_scanners(
    std::span<const std::filesystem::path> configs, const MayCommand& may) {
  std::vector<std::unique_ptr<ScannerBackend>> scanners;
  std::set<std::string> names;
  for (const std::filesystem::path& path : configs) {
    auto config = acquisition::read_scanner_config(path);
    if (!config) return tl::unexpected(config.error());
    if (auto named = check_name(config->name, path); !named) return tl::unexpected(named.error());
    if (!names.insert(config->name).second) {
      return fail(ErrorCode::kBadInput,
                  fmt::format("{}: another scanner is named {}; give one of them another name",
                              path.string(), config->name));
    }
    acquisition::Scanner scanner = acquisition::open_scanner(*config);
    scanner.devices =
        fenced(std::move(scanner.devices), [may, name = config->name] { return may(name); });
    scanners.push_back(std::make_unique<SessionBackend>(std::move(*config), std::move(scanner)));
  }
  return scanners;
}

}  // namespace vitrine::server
