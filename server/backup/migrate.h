// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "server/store/installation.h"

namespace vitrine {

struct MigrationReport {
  std::size_t models = 0, files = 0;
  std::uint64_t bytes = 0;  // of the files
};

// After each file: how many of how many are there.
using MigrationProgress = std::function<void(std::size_t done, std::size_t all)>;

// Copies an installation into another: the files first, each checked against its SHA-256 on both
// sides, and then, while nobody may publish at either, those that have come meanwhile and the whole
// catalogue in one transaction. Until then the other shows nothing of it, and whoever is
// interrupted begins again: what is there already is checked and not sent again. Uploads and what
// scans have left stay in their data folder. kState where the other is not new, kBadInput where a
// file is damaged, kIo.
Expected<MigrationReport> migrate(Installation& from, Installation& to,
                                  const MigrationProgress& progress);

}  // namespace vitrine
