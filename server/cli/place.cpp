// SPDX-License-Identifier: Apache-2.0
#include "server/cli/place.h"

#include <unistd.h>

#include <vector>

#include "server/config/read_file.h"
#include "server/jobs/place_of.h"

namespace vitrine::cli {

Expected<InstallationPlace> place_of(const std::string& text) {
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(text, unknown)) return InstallationPlace{.folder = text};
  std::vector<std::string_view> environment;
  for (char** entry = environ; *entry != nullptr; ++entry)
    environment.emplace_back(*entry);
  const auto settings = read_settings(text, environment);
  if (!settings) return Unexpected(settings.error());
  return vitrine::place_of(*settings);
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
