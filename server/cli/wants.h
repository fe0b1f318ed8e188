// SPDX-License-Identifier: Apache-2.0
// How much of a model the command line asks for.
#pragma once

#include <optional>

#include "codec/progressive/planner.h"
#include "server/cli/arguments.h"

namespace vitrine::cli {

// Of --level, --triangles, --bytes and --error, where the command has declared them and one is
// given. Nothing: the finest level.
tl::expected<std::optional<Want>, Fault> read_want(const Arguments& arguments);

// No level meets a want beyond the coarsest or the finest: fails with kState instead of giving
// another one.
Expected<void> check_want(const Manifest& manifest, const Want& want);

}  // namespace vitrine::cli
