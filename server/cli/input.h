// SPDX-License-Identifier: Apache-2.0
// The bytes of an input file.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "codec/core/expected.h"

namespace vitrine::cli {

// Fails where writing `out` would replace the input `path`: a scan may have no second copy.
Expected<void> check_distinct(const std::string& path, const std::string& out);

// A file mapped into memory, read-only.
class InputFile {
 public:
  // Fails (kIo, kBadInput) on a missing, unreadable or empty file and on anything but a file.
  static Expected<InputFile> open(const std::string& path);
  // The same for a file that must be a mesh: fails on a .pmesh.
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

}  // namespace vitrine::cli
