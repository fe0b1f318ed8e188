// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "server/jobs/scanner_backend.h"

namespace vitrine {

// Whether a scanner may be commanded now.
using MayCommand = std::function<Expected<void>(const std::string& scanner)>;

// The scanners that rig.json files describe, commanded as long as they may be. Nothing is opened
// yet. Fails (kBadInput) where two have one name or a name is none for a path, and as
// read_scanner_config().
Expected<std::vector<std::unique_ptr<ScannerBackend>>> open_scanners(
    std::span<const std::filesystem::path> configs, const MayCommand& may);

}  // namespace vitrine
