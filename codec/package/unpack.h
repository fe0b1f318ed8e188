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

// Largest total size of a package's unpacked files, in bytes. This total is also at most
// kMostUnpackedPerByte times the size of the package; deflate reaches a ratio of 1032.
inline constexpr std::uint64_t kMostUnpackedBytes = 16ull << 30;
inline constexpr std::uint64_t kMostUnpackedPerByte = 1'040;
inline constexpr std::size_t kMostPackedFiles = 65'536;
inline constexpr std::size_t kMostPathBytes = 1'024;
// A file that is not kept whole is cut after this number of bytes, which suffice to recognise its
// kind.
inline constexpr std::size_t kHeadBytes = 4'096;

struct PackedFile {
  std::string path;  // parts are separated by slashes; UTF-8 without control characters
  std::vector<std::uint8_t> bytes;
};

// Whether the bytes begin like a zip, tar or gzip package. False for a zip without files.
bool is_package(std::span<const std::uint8_t> bytes);

// Returns the files of a package in their order, without folders and links. Cuts the files for
// which `keeps_whole(path)` is false after kHeadBytes. A whole file that is a package is replaced
// by the files in it, up to three levels deep. A file compressed by gzip has the path of its
// package without ".gz", or an empty path if it is the whole package. Verifies the checksums of zip
// and gzip.
//
// Allocates at most about the unpacked size of the package, or twice that for a tar inside of gzip.
// Fails with kBadInput if the package is damaged or encrypted, or has a path that is absolute or
// contains "..". Fails with kUnsupported if a zip uses another compression method than deflate, and
// with kLimit if the package exceeds a limit above.
Expected<std::vector<PackedFile>> unpack(
    std::span<const std::uint8_t> package,
    const std::function<bool(std::string_view path)>& keeps_whole);

}  // namespace vitrine::inline codec
