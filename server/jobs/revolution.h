// SPDX-License-Identifier: Apache-2.0
// Records in a scan's data folder the ID of the table revolution in which the scan's steps were
// measured. If another daemon continues the scan, it uses a folder of its own and begins a new
// revolution, because the table has moved.
#pragma once

#include <filesystem>
#include <string>

#include "codec/core/expected.h"

namespace vitrine::server {

// Whether the folder contains the steps of the revolution whose ID is `revolution` (see
// ScanEntry::revolution). An empty ID matches a folder that an earlier version of Vitrine made.
// Fails with kIo if the folder exists and cannot be read.
Expected<bool> holds_revolution(const std::filesystem::path& folder, const std::string& revolution);

// Empties the folder and records the revolution's ID in it.
Expected<void> begin_revolution(const std::filesystem::path& folder, const std::string& revolution);

// Deletes the folder of a scan. If the machine crashes during the call, either the whole folder is
// left or none of it. Fails with kIo.
Expected<void> remove_revolution(const std::filesystem::path& folder);

// Deletes the remains of interrupted remove_revolution() calls in `scans`, the folder of all scans.
void sweep_removed_revolutions(const std::filesystem::path& scans);

}  // namespace vitrine::server
