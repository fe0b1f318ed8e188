// SPDX-License-Identifier: Apache-2.0
// The flags that say what a mesh file itself does not.
#pragma once

#include "codec/import/read_mesh.h"
#include "server/cli/arguments.h"

namespace vitrine::cli {

inline constexpr Flag kUnitFlag = {"--unit", "mm|cm|m|in",
                                   "unit of IN (default: what it states; GLB is in m)"};
inline constexpr Flag kUpFlag = {"--up", "y|z",
                                 "the axis of IN that points up (default y); z is turned to y"};

// Of commands that declare one flag or both.
tl::expected<ReadOptions, Fault> reading_options(const Arguments& arguments);

}  // namespace vitrine::cli
