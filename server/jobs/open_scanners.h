// SPDX-License-Identifier: Apache-2.0
// Creates the backends of the scanners that the configuration lists.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "server/jobs/scanner_backend.h"

namespace vitrine::server {

// Checks whether this daemon may command the scanner at the moment; returns an error if not.
using MayCommand = std::function<Expected<void>(const std::string& scanner)>;

// Creates a backend for each rig.json file, without opening its devices. Commands to a scanner fail
// as long as `may` returns an error for it. Fails with kBadInput if two scanners have the same
// name, or if a name contains characters other than a-z, 0-9 and -. Also fails with the errors of
// read_scanner_config().
Expected<std::vector<std::unique_ptr<ScannerBackend>>> open_scanners(
    std::span<const std::filesystem::path> configs, const MayCommand& may);

}  // namespace vitrine::server
