// SPDX-License-Identifier: Apache-2.0
// Backs up an installation to one file, and restores an installation from such a file. The file is
// a plain tar archive with the layout of a data folder: objects, scans, the catalogue, and at the
// end SHA256SUMS, which lists all files for sha256sum(1). A truncated archive is detected, because
// it lacks SHA256SUMS. If the installation has lost objects, the archive has the file DAMAGED,
// which lists them in the format of SHA256SUMS.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "codec/core/expected.h"

namespace vitrine::server {

struct BackupReport {
  std::uint64_t models = 0, files = 0, bytes = 0;  // `bytes` is the total size of the files
  // One line for each file that the backup lacks and for each fault of the catalogue.
  std::vector<std::string> damaged;
};

// Backs up the installation in `data` to `file`. Writes the file completely or not at all. A daemon
// may serve the installation during the backup. The backup shows the state at one moment. Only
// scans in progress may be incomplete, as after a crash of the daemon. Checks the hash of every
// object. Leaves out damaged files and lists them in the report. Fails with kIo if the catalogue
// cannot be read or the backup cannot be written.
Expected<BackupReport> back_up(const std::filesystem::path& data,
                               const std::filesystem::path& file);

// Restores a backup into `data`, which must be absent or empty, so that nothing is overwritten.
// Checks all hashes and restores the catalogue last. The report lists the objects that were damaged
// when the backup was made. Leaves `data` unchanged on failure. Fails with kLimit if the disk of
// `data` has less room than the file needs, with kBadInput if the file is not a backup or is
// damaged, and with kIo if a file cannot be read or written.
Expected<BackupReport> restore(const std::filesystem::path& file,
                               const std::filesystem::path& data);

}  // namespace vitrine::server
