// SPDX-License-Identifier: Apache-2.0
// Flags for properties that a mesh file does not state: its unit and its upward axis.
#pragma once

#include "codec/import/read_mesh.h"
#include "server/cli/support/arguments.h"

namespace vitrine::server::cli {

inline constexpr Flag kUnitFlag = {"--unit", "mm|cm|m|in",
                                   "unit of IN (default: the one IN states, m for GLB, else none)"};
inline constexpr Flag kUpFlag = {
    "--up", "y|z", "axis of IN that points up (default y); the result always has y up"};

// Reads the flags; the command must declare one of them or both.
tl::expected<ReadOptions, Fault> reading_options(const Arguments& arguments);

// Returns a note if `options` states another unit than the mesh file. Otherwise returns an empty
// text. Must run in the sandbox if the bytes are untrusted.
std::string note_on_unit(std::span<const std::uint8_t> mesh, const ReadOptions& options);

}  // namespace vitrine::server::cli
