// SPDX-License-Identifier: Apache-2.0
// A tar archive (pax) of files that fit into memory, one after the other.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "codec/core/expected.h"
#include "codec/files/file_descriptor.h"

struct archive;

namespace vitrine {

// Writes to a temporary file beside `file`, which is for its owner alone; finish() gives it its
// name. All calls fail with kIo.
class TarWriter {
 public:
  static Expected<TarWriter> create(const std::filesystem::path& file);

  Expected<void> add(const std::string& name, std::span<const std::uint8_t> bytes);
  Expected<void> finish();

 private:
  struct Remove {  // the temporary file, where it has not been renamed
    void operator()(std::filesystem::path* path) const;
  };
  struct Close {
    void operator()(archive* handle) const;
  };
  using Handle = std::unique_ptr<archive, Close>;
  TarWriter(std::filesystem::path file, std::filesystem::path temporary);
  Unexpected refused(const char* why) const;

  std::filesystem::path file_;
  std::unique_ptr<std::filesystem::path, Remove> temporary_;
  FileDescriptor fd_;
  Handle handle_;
};

struct TarEntry {
  std::string name;  // as it stands there: hostile text
  std::vector<std::uint8_t> bytes;
};

// Safe on hostile bytes: fails with kBadInput where they are no tar, hold anything but regular
// files, or a file of more than kMaxFile; kIo where the file cannot be opened.
class TarReader {
 public:
  static constexpr std::uint64_t kMaxFile = std::uint64_t{4} << 30;

  static Expected<TarReader> open(const std::filesystem::path& file);

  Expected<std::optional<TarEntry>> next();  // nothing at the end

 private:
  struct Close {
    void operator()(archive* handle) const;
  };
  using Handle = std::unique_ptr<archive, Close>;
  TarReader(std::filesystem::path file, Handle handle);
  Unexpected damaged(const char* why) const;

  std::filesystem::path file_;
  Handle handle_;
};

}  // namespace vitrine
