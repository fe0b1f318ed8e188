// SPDX-License-Identifier: Apache-2.0
// A file that keeps where the table stands while no rig runs.
#pragma once

#include <filesystem>

#include "codec/core/expected.h"

namespace vitrine::rig {

// Degrees; 0 where there is no such file. Fails where it holds anything but a number.
Expected<double> read_table(const std::filesystem::path& file);

Expected<void> write_table(const std::filesystem::path& file, double degrees);

}  // namespace vitrine::rig
