// SPDX-License-Identifier: Apache-2.0
// Defines the command-line flags for the format of a mesh file, and for properties that the file
// may not state, such as its unit and its upward axis.
#pragma once

#include "codec/import/formats.h"
#include "server/cli/support/arguments.h"

namespace vitrine::server::cli {

inline constexpr Flag kUnitFlag = {
    "--unit", "mm|cm|m|in",
    "unit of IN (default: the one IN states, m for GLB and glTF, else none)"};
inline constexpr Flag kUpFlag = {
    "--up", "y|z", "axis of IN that points up (default y); the result always has y up"};

inline constexpr FixedText kImportChoice = join(
    kImportFormats, [](const ImportFormat& format) { return format.extension; }, "|", "|");
inline constexpr Flag kFormatFlag = {"--format", kImportChoice,
                                     "format that IN must have, for example to check standard "
                                     "input (default: recognised by content)"};

// Reads kFormatFlag. Returns null if it is absent.
tl::expected<const ImportFormat*, Fault> stated_format(const Arguments& arguments);

// Fails (kBadInput) if the mesh has another format than `stated`. Always succeeds for a package.
// Must run in the sandbox if the bytes are untrusted.
Expected<void> check_format(std::span<const std::uint8_t> mesh, const ImportFormat* stated);

// Reads kUnitFlag and kUpFlag; the command must declare one of them or both.
tl::expected<ReadOptions, Fault> reading_options(const Arguments& arguments);

// Returns a note if `options` states another unit than the mesh file. Otherwise returns an empty
// text. Must run in the sandbox if the bytes are untrusted.
std::string note_on_unit(std::span<const std::uint8_t> mesh, const ReadOptions& options);

}  // namespace vitrine::server::cli
