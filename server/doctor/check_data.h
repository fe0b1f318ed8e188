// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "server/doctor/finding.h"

namespace vitrine {

// A data folder: who may use it, its disk, its catalogue and the files of its models. Changes
// nothing, but for a copy of the catalogue beside it, which is gone afterwards.
Findings check_data(const std::filesystem::path& data);

}  // namespace vitrine
