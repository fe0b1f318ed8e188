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

// What to know where `options` have another unit than the mesh file states, else empty. For
// untrusted bytes, but in the sandbox.
std::string note_on_unit(std::span<const std::uint8_t> mesh, const ReadOptions& options);

}  // namespace vitrine::cli
