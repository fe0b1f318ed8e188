// SPDX-License-Identifier: Apache-2.0
#include "server/cli/place.h"

#include <unistd.h>

#include <optional>
#include <vector>

#include "server/config/read_file.h"
#include "server/jobs/place_of.h"
#include "server/store/quota.h"

namespace vitrine::cli {

namespace {

// Nothing where it is not a configuration file.
Expected<std::optional<Settings>> settings_in(const std::string& text) {
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(text, unknown)) return std::nullopt;
  std::vector<std::string_view> environment;
  for (char** entry = environ; *entry != nullptr; ++entry)
    environment.emplace_back(*entry);
  auto settings = read_settings(text, environment);
  if (!settings) return Unexpected(settings.error());
  return std::move(*settings);
}

}  // namespace

Expected<InstallationPlace> place_of(const std::string& text) {
  const auto settings = settings_in(text);
  if (!settings) return Unexpected(settings.error());
  return *settings ? vitrine::place_of(**settings) : InstallationPlace{.folder = text};
}

Expected<Room> room_of(const std::string& text) {
  const auto settings = settings_in(text);
  if (!settings) return Unexpected(settings.error());
  if (*settings) return Room{(*settings)->quota_bytes, uploads_of(**settings)};
  const auto bytes = read_quota(text);
  if (!bytes) return Unexpected(bytes.error());
  return Room{*bytes, std::filesystem::path(text) / "uploads"};
}

Expected<void> check_existing(const InstallationPlace& place) {
  if (auto usable = check_installation(place.folder); !usable) return usable;
  return place.catalogue.empty() ? check_data_folder(place.folder) : Expected<void>();
}

Expected<Installation> open_existing(const std::string& text) {
  const auto place = place_of(text);
  if (!place) return Unexpected(place.error());
  if (auto there = check_existing(*place); !there) return Unexpected(there.error());
  return open_installation(*place);
}

}  // namespace vitrine::cli
