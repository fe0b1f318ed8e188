// SPDX-License-Identifier: Apache-2.0
// Opens and maps input files.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "codec/core/expected.h"

namespace vitrine::server::cli {

// Fails if writing `out` would overwrite the input `path`, since there may be no second copy of a
// scan.
Expected<void> check_distinct(const std::string& path, const std::string& out);

// A file mapped into memory, read-only.
class InputFile {
 public:
  // Maps a file. Fails if it is missing, unreadable or not a regular file (kIo), or empty
  // (kBadInput).
  static Expected<InputFile> open(const std::string& path);
  // Like open(), but also fails (kBadInput) for a .pmesh file.
  static Expected<InputFile> open_mesh(const std::string& path);
  InputFile(InputFile&& other) noexcept;
  InputFile& operator=(InputFile&&) = delete;
  ~InputFile();

  std::span<const std::uint8_t> bytes() const { return bytes_; }

  // Whether the first bytes are the signature of a .pmesh of any version.
  bool is_pmesh() const;

 private:
  explicit InputFile(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  std::span<const std::uint8_t> bytes_;
};

}  // namespace vitrine::server::cli
