// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "server/store/installation.h"

namespace vitrine::cli {

// The installation that a person means: its data folder, or the configuration file of its daemon,
// which may name a bucket and a database; the environment goes before the file.
Expected<InstallationPlace> place_of(const std::string& text);

// What its models and uploads together may take: as the file says, or the daemon has left it in
// the folder.
struct Room {
  std::uint64_t bytes = 0;  // 0: no limit
  std::filesystem::path uploads;
};
Expected<Room> room_of(const std::string& text);

// Whether it is there, or an empty folder: a mistyped name makes no installation. Fails with kIo.
Expected<void> check_existing(const InstallationPlace& place);

// Opens such a one.
Expected<Installation> open_existing(const std::string& text);

}  // namespace vitrine::cli
