// SPDX-License-Identifier: Apache-2.0
#include "server/cli/support/place.h"

#include <unistd.h>

#include <optional>
#include <vector>

#include "server/config/read_file.h"
#include "server/jobs/place_of.h"

namespace vitrine::server::cli {

namespace {

// Reads the settings from the configuration file at the path `text`. Returns nullopt if there is no
// regular file.
Expected<std::optional<Settings>> settings_in(const std::string& text) {
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(text, unknown)) return std::nullopt;
  std::vector<std::string_view> environment;
  for (char** entry = environ; *entry != nullptr; ++entry)
    environment.emplace_back(*entry);
  auto settings = read_settings(text, environment);
  if (!settings) return tl::unexpected(settings.error());
  return std::move(*settings);
}

}  // namespace

Expected<InstallationPlace> place_of(const std::string& text) {
  const auto settings = settings_in(text);
  if (!settings) return tl::unexpected(settings.error());
  return *settings ? server::place_of(**settings) : InstallationPlace{.folder = text};
}

Expected<StorageLimits> storage_limits_of(const std::string& text) {
  const auto settings = settings_in(text);
  if (!settings) return tl::unexpected(settings.error());
  if (*settings) return StorageLimits{disk_limits_of(**settings), uploads_of(**settings)};
  const auto limits = read_limits(text);
  if (!limits) return tl::unexpected(limits.error());
  return StorageLimits{*limits, std::filesystem::path(text) / "uploads"};
}

Expected<void> check_existing(const InstallationPlace& place) {
  if (auto usable = check_installation(place.folder); !usable) return usable;
  return place.catalogue.empty() ? check_data_folder(place.folder) : Expected<void>();
}

Expected<Installation> open_existing(const std::string& text) {
  const auto place = place_of(text);
  if (!place) return tl::unexpected(place.error());
  if (auto there = check_existing(*place); !there) return tl::unexpected(there.error());
  return open_installation(*place);
}

}  // namespace vitrine::server::cli
