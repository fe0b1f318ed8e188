// SPDX-License-Identifier: Apache-2.0
#include "server/backup/tar.h"

#include <archive.h>
#include <archive_entry.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>

#include "codec/files/atomic_file.h"
#include "server/catalogue/private_file.h"

namespace vitrine::server {
namespace {

namespace fs = std::filesystem;

struct FreeEntry {
  void operator()(archive_entry* entry) const { archive_entry_free(entry); }
};

}  // namespace

void TarWriter::RemoveFile::operator()(fs::path* path) const {
  ::unlink(path->c_str());
  delete path;
}

void TarWriter::FreeWriter::operator()(archive* handle) const {
  archive_write_free(handle);
}

TarWriter::TarWriter(fs::path file, fs::path temporary)
    : file_(std::move(file)),
      temporary_(new fs::path(std::move(temporary))),
      fd_(create_private_file(*temporary_)),
      handle_(archive_write_new()) {}

Unexpected TarWriter::refused(const char* why) const {
  return fail(ErrorCode::kIo, fmt::format("cannot write {}: {}; check the disk and its free space",
                                          file_.string(), why));
}

Expected<TarWriter> TarWriter::create(const fs::path& file) {
  if (auto writable = check_writable(file); !writable) return tl::unexpected(writable.error());
  fs::path temporary =
      folder_of(file) / fmt::format(".{}.{}.part", file.filename().string(), ::getpid());
  TarWriter writer(file, std::move(temporary));
  if (!writer.fd_) return writer.refused(std::strerror(errno));
  archive* handle = writer.handle_.get();
  archive_write_set_format_pax_restricted(handle);
  if (archive_write_open_fd(handle, writer.fd_.get()) != ARCHIVE_OK)
    return writer.refused(archive_error_string(handle));
  return writer;
}

Expected<void> TarWriter::add(const std::string& name, std::span<const std::uint8_t> bytes) {
  const std::unique_ptr<archive_entry, FreeEntry> entry(archive_entry_new());
  archive_entry_set_pathname(entry.get(), name.c_str());
  archive_entry_set_size(entry.get(), static_cast<la_int64_t>(bytes.size()));
  archive_entry_set_filetype(entry.get(), AE_IFREG);
  archive_entry_set_perm(entry.get(), 0640);
  archive_entry_set_mtime(entry.get(), std::time(nullptr), 0);
  archive* handle = handle_.get();
  if (archive_write_header(handle, entry.get()) != ARCHIVE_OK)
    return refused(archive_error_string(handle));
  while (!bytes.empty()) {
    const la_ssize_t taken = archive_write_data(handle, bytes.data(), bytes.size());
    if (taken <= 0) return refused(archive_error_string(handle));
    bytes = bytes.subspan(static_cast<std::size_t>(taken));
  }
  return {};
}

Expected<void> TarWriter::finish() {
  if (archive_write_close(handle_.get()) != ARCHIVE_OK)
    return refused(archive_error_string(handle_.get()));
  if (::fsync(fd_.get()) != 0) return refused(std::strerror(errno));
  if (::rename(temporary_->c_str(), file_.c_str()) != 0) return refused(std::strerror(errno));
  return sync_folder(folder_of(file_));
}

void TarReader::FreeReader::operator()(archive* handle) const {
  archive_read_free(handle);
}

TarReader::TarReader(fs::path file, Handle handle)
    : file_(std::move(file)), handle_(std::move(handle)) {}

Unexpected TarReader::damaged(const char* why) const {
  return fail(ErrorCode::kBadInput, fmt::format("{} is not a complete backup: {}; use another one",
                                                file_.string(), why == nullptr ? "" : why));
}

Expected<TarReader> TarReader::open(const fs::path& file) {
  if (::access(file.c_str(), R_OK) != 0) {
    return fail(ErrorCode::kIo, fmt::format("cannot read {}: {}; check the name", file.string(),
                                            std::strerror(errno)));
  }
  TarReader reader(file, Handle(archive_read_new()));
  archive* handle = reader.handle_.get();
  archive_read_support_format_tar(handle);
  constexpr std::size_t kBlock = 64 * 1024;
  if (archive_read_open_filename(handle, file.c_str(), kBlock) != ARCHIVE_OK)
    return reader.damaged(archive_error_string(handle));
  return reader;
}

Expected<std::optional<TarEntry>> TarReader::next() {
  archive* handle = handle_.get();
  archive_entry* header = nullptr;
  const int found = archive_read_next_header(handle, &header);
  if (found == ARCHIVE_EOF) return std::nullopt;
  if (found != ARCHIVE_OK) return damaged(archive_error_string(handle));
  const char* name = archive_entry_pathname(header);
  if (name == nullptr || archive_entry_filetype(header) != AE_IFREG ||
      archive_entry_hardlink(header) != nullptr)
    return damaged("it contains entries that are not files");
  const auto size = static_cast<std::uint64_t>(std::max<la_int64_t>(archive_entry_size(header), 0));
  std::error_code unknown;
  if (size > kMaxFile || size > fs::file_size(file_, unknown))
    return damaged("the stated length of a file is too large");
  TarEntry entry{name, std::vector<std::uint8_t>(size)};
  for (std::size_t at = 0; at < size;) {
    const la_ssize_t taken = archive_read_data(handle, entry.bytes.data() + at, size - at);
    if (taken <= 0) return damaged(taken < 0 ? archive_error_string(handle) : "it is cut short");
    at += static_cast<std::size_t>(taken);
  }
  return entry;
}

}  // namespace vitrine::server
