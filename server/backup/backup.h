// SPDX-License-Identifier: Apache-2.0
// An installation as one file, and back. The file is a plain tar with the layout of a data folder,
// its objects and scans first, then the catalogue, then SHA256SUMS of all of them, which
// sha256sum(1) reads as well; so what is cut short has no catalogue.
#pragma once

#include <cstdint>
#include <filesystem>

#include "codec/core/expected.h"

namespace vitrine {

struct BackupReport {
  std::uint64_t models = 0, files = 0, bytes = 0;  // bytes: of the files
};

// Writes the installation in `data` to `file`, which is whole or absent. A daemon may serve it
// meanwhile: the backup holds it as it is at one moment, but for scans under way, which are as a
// crash would leave them. Each object is read and must have its hash. Fails with kIo, and with
// kState where the installation is damaged.
Expected<BackupReport> back_up(const std::filesystem::path& data,
                               const std::filesystem::path& file);

// Makes the installation of a backup in `data`, which is absent or empty: nothing is ever
// overwritten. All hashes are checked, and the catalogue comes last. Fails with kBadInput where the
// file is no backup, or damaged, and kIo; `data` is then as it was.
Expected<BackupReport> restore(const std::filesystem::path& file,
                               const std::filesystem::path& data);

}  // namespace vitrine
