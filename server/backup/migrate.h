// SPDX-License-Identifier: Apache-2.0
// Copies an installation to other storage while it is in use.
#pragma once

#include <functional>
#include <vector>

#include "server/store/disk_space.h"
#include "server/store/installation.h"
#include "server/store/scrub.h"

namespace vitrine::server {

struct MigrationReport {
  std::size_t models = 0, files = 0;
  std::uint64_t bytes = 0;  // total size of the files
  // Damaged and missing files of the source that the destination does not have intact either.
  std::vector<DamagedFile> damaged;
};

// Called after each copied file with the number of copied files and the total number of files.
using MigrationProgress = std::function<void(std::size_t done, std::size_t all)>;

// Copies the installation `from` into `to`. First copies the files and checks the SHA-256 of each
// file on both sides. Then blocks publishing on both sides, copies the files that were added
// meanwhile, and copies the whole catalogue in one transaction. The destination shows no model
// before that transaction. After an interruption, call the function again: it checks files that
// exist already instead of copying them. Leaves out damaged and missing files, and lists them in
// the report unless the destination has them intact; repair() can put them back at the destination.
// Does not copy uploads and the data of scans, which stay in their data folder. If the files to be
// copied exceed `limits`, the limits of the destination, fails with kLimit before it copies any.
// Fails with kState if the destination contains other data, and with kIo if a store or a catalogue
// fails.
Expected<MigrationReport> migrate(Installation& from, Installation& to,
                                  const MigrationProgress& progress,
                                  const StorageLimits& limits = {});

}  // namespace vitrine::server
