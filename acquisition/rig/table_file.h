// SPDX-License-Identifier: Apache-2.0
// A file that keeps the table's angle between runs of the rig.
#pragma once

#include <filesystem>

#include "codec/core/expected.h"

namespace vitrine::acquisition::rig {

// Returns the table's angle in degrees, or 0 if the file does not exist. Fails if the file holds
// anything but a number.
Expected<double> read_table(const std::filesystem::path& file);

Expected<void> write_table(const std::filesystem::path& file, double degrees);

}  // namespace vitrine::acquisition::rig
