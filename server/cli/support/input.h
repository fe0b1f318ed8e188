// SPDX-License-Identifier: Apache-2.0
// Opens and maps input files, or reads standard input.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "codec/core/expected.h"

namespace vitrine::server::cli {

// The name "-" means standard input for an input file, and standard output for an output file.
inline constexpr std::string_view kStandardStream = "-";

// Returns the name of an input in messages: its path, or "standard input".
std::string input_name(const std::string& path);

// Fails if writing `out` would overwrite the input `path`, which may be the only copy of a scan.
Expected<void> check_distinct(const std::string& path, const std::string& out);

// A file mapped into memory, read-only.
class InputFile {
 public:
  // Maps a file. Fails if the file is missing, unreadable or not a regular file (kIo), or is empty
  // (kBadInput). If `path` is kStandardStream, reads standard input to its end into memory; this
  // fails (kLimit) if it has more than 4 GiB.
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
  static Expected<InputFile> map(int fd, const std::string& name);

  explicit InputFile(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  std::span<const std::uint8_t> bytes_;
};

}  // namespace vitrine::server::cli
