// SPDX-License-Identifier: Apache-2.0
// Reads the detail target from the command line.
#pragma once

#include <optional>

#include "codec/plan/planner.h"
#include "server/cli/support/arguments.h"

namespace vitrine::server::cli {

// Reads the flags --level, --triangles, --bytes and --error, as far as the command declares them,
// and returns the detail target. Returns nullopt if the user gave none of these flags, which means
// the finest level. Fails if the user gave several of them.
tl::expected<std::optional<Want>, Fault> read_want(const Arguments& arguments);

// Fails with kState if no level of the model is as coarse or as fine as the target requires.
Expected<void> check_want(const Manifest& manifest, const Want& want);

}  // namespace vitrine::server::cli
