// SPDX-License-Identifier: Apache-2.0
// Reads the detail target from the command line.
#pragma once

#include <optional>

#include "codec/plan/planner.h"
#include "server/cli/support/arguments.h"

namespace vitrine::server::cli {

// Reads those of the flags --level, --triangles, --bytes and --error that the command declares, and
// returns the target that the user gives. Returns nullopt if none is given, which means the finest
// level. Fails if several are given.
tl::expected<std::optional<Want>, Fault> read_want(const Arguments& arguments);

// Fails with kState if the model has no level as coarse or as fine as the target requires.
Expected<void> check_want(const Manifest& manifest, const Want& want);

}  // namespace vitrine::server::cli
