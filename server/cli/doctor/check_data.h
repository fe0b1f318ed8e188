// SPDX-License-Identifier: Apache-2.0
// Checks a data folder.
#pragma once

#include <filesystem>

#include "server/cli/doctor/finding.h"

namespace vitrine::server {

// Checks permissions, disk space, the catalogue and the files of all models. Changes nothing, but
// makes a temporary copy of the catalogue in the folder.
Findings check_data(const std::filesystem::path& data);

}  // namespace vitrine::server
