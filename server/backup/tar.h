// SPDX-License-Identifier: Apache-2.0
// Reads and writes tar archives in the pax format. Each file in an archive must fit into memory.
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

namespace vitrine::server {

// Writes an archive to a temporary file beside `file`. Only the owner can read the archive.
// finish() renames the temporary file to `file`. All functions fail with kIo.
class TarWriter {
 public:
  static Expected<TarWriter> create(const std::filesystem::path& file);

  Expected<void> add(const std::string& name, std::span<const std::uint8_t> bytes);
  Expected<void> finish();

 private:
  struct RemoveFile {  // removes the temporary file unless finish() has renamed it
    void operator()(std::filesystem::path* path) const;
  };
  struct FreeWriter {
    void operator()(archive* handle) const;
  };
  TarWriter(std::filesystem::path file, std::filesystem::path temporary);
  Unexpected refused(const char* why) const;

  std::filesystem::path file_;
  std::unique_ptr<std::filesystem::path, RemoveFile> temporary_;
  FileDescriptor fd_;
  std::unique_ptr<archive, FreeWriter> handle_;
};

struct TarEntry {
  std::string name;  // path as stored in the archive; may be hostile
  std::vector<std::uint8_t> bytes;
};

// Reads an archive, which may be hostile. Fails with kBadInput if the file is not a tar archive,
// has entries other than regular files, or has a file larger than kMaxFile. Fails with kIo if the
// file cannot be opened.
class TarReader {
 public:
  static constexpr std::uint64_t kMaxFile = std::uint64_t{4} << 30;

  static Expected<TarReader> open(const std::filesystem::path& file);

  Expected<std::optional<TarEntry>> next();  // returns nullopt after the last entry

 private:
  struct FreeReader {
    void operator()(archive* handle) const;
  };
  using Handle = std::unique_ptr<archive, FreeReader>;
  TarReader(std::filesystem::path file, Handle handle);
  Unexpected damaged(const char* why) const;

  std::filesystem::path file_;
  Handle handle_;
};

}  // namespace vitrine::server
