// SPDX-License-Identifier: Apache-2.0
// Unpacks zip, tar and gzip packages in memory. Nothing is written to the disk, so the names in a
// package cannot lead to other files.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "codec/core/expected.h"

namespace vitrine::inline codec {

// Largest size of all files of a package together, in bytes. A package also unpacks to at most
// kMostUnpackedPerByte times its own size; deflate reaches 1032.
inline constexpr std::uint64_t kMostUnpackedBytes = 16ull << 30;
inline constexpr std::uint64_t kMostUnpackedPerByte = 1'040;
inline constexpr std::size_t kMostPackedFiles = 65'536;
inline constexpr std::size_t kMostPathBytes = 1'024;
// Files that are not wanted whole are kept up to this size in bytes, so that their kind can be
// told.
inline constexpr std::size_t kHeadBytes = 4'096;

struct PackedFile {
  std::string path;  // parts are separated by slashes; UTF-8 without control characters
  std::vector<std::uint8_t> bytes;
};

// Whether the bytes begin like a zip, tar or gzip package. False for a zip without files.
bool is_package(std::span<const std::uint8_t> bytes);

// Returns the files of a package in its order, without folders and links. Files for which
// `keeps_whole(path)` is false are cut after kHeadBytes. Packages among the others are unpacked in
// place, up to three inside each other. A file compressed by gzip has the path of its package
// without ".gz", or an empty path if it is the whole package. Checks the checksums of zip and gzip.
//
// Allocates at most about the unpacked size of the package, twice for a tar inside of gzip. Fails
// with kBadInput if the package is damaged, encrypted, or has a path that is absolute or contains
// "..", with kUnsupported if a zip is compressed by another method than deflate, and with kLimit
// if it exceeds a limit above.
Expected<std::vector<PackedFile>> unpack(
    std::span<const std::uint8_t> package,
    const std::function<bool(std::string_view path)>& keeps_whole);

}  // namespace vitrine::inline codec
