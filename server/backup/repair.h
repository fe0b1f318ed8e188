// SPDX-License-Identifier: Apache-2.0
// Replaces damaged and missing objects of an installation by intact copies.
#pragma once

#include <filesystem>
#include <functional>
#include <set>
#include <span>
#include <vector>

#include "server/store/installation.h"
#include "server/store/scrub.h"

namespace vitrine::server {

// Receives the bytes of an object and its SHA-256.
using TakeCopy =
    std::function<Expected<void>(const Sha256& name, std::span<const std::uint8_t> bytes)>;

// Calls `take` for each wanted object of which the source has an intact copy.
using CopySource =
    std::function<Expected<void>(const std::set<Sha256>& wanted, const TakeCopy& take)>;

// Returns a source that reads the copies in a backup. The source fails with kBadInput if the file
// is not a backup, and with kIo if the file cannot be read.
CopySource copies_in_backup(const std::filesystem::path& file);

// Returns a source that reads the copies in another store, which must outlive the result. The
// source fails with kIo.
CopySource copies_in_store(const ObjectStore& store);

struct RepairReport {
  std::uint64_t objects = 0;  // number of checked objects
  std::vector<DamagedFile> repaired;
  std::vector<DamagedFile>
      damaged;  // objects that are still damaged or missing because the source has no intact copy
};

// Checks all objects of the installation, and replaces damaged and missing objects by copies from
// `source`. Daemons may serve the installation during the repair, and serve repaired models at
// once. If the missing objects would leave less than `disk_reserve` bytes free on the disk, fails
// with kLimit before it changes any object. Fails with kIo if a store or the catalogue fails, and
// with kBadInput if the source is malformed.
Expected<RepairReport> repair(Installation& installation, const CopySource& source,
                              std::uint64_t disk_reserve = 0);

}  // namespace vitrine::server
