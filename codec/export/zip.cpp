// SPDX-License-Identifier: Apache-2.0
#include "codec/export/zip.h"

#include <archive.h>
#include <archive_entry.h>

#include <memory>
#include <string>

namespace vitrine::inline codec {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Archive = std::unique_ptr<archive, decltype(&archive_write_free)>;
using Entry = std::unique_ptr<archive_entry, decltype(&archive_entry_free)>;

Unexpected zip_fault(archive* handle) {
  const char* why = archive_error_string(handle);
  return fail(ErrorCode::kIo, std::string("cannot write the zip: ") +
                                  (why != nullptr ? why : "memory ran out") + "; try again");
}

la_ssize_t append(archive*, void* out, const void* bytes, std::size_t size) {
  const auto* first = static_cast<const std::uint8_t*>(bytes);
  auto& all = *static_cast<Bytes*>(out);
  all.insert(all.end(), first, first + size);
  return static_cast<la_ssize_t>(size);
}

bool add(archive* handle, const MeshFile& file) {
  const Entry entry(archive_entry_new(), archive_entry_free);
  archive_entry_set_pathname(entry.get(), file.name.c_str());
  archive_entry_set_size(entry.get(), static_cast<la_int64_t>(file.bytes.size()));
  archive_entry_set_filetype(entry.get(), AE_IFREG);
  archive_entry_set_perm(entry.get(), 0644);
  return archive_write_header(handle, entry.get()) == ARCHIVE_OK &&
         archive_write_data(handle, file.bytes.data(), file.bytes.size()) ==
             static_cast<la_ssize_t>(file.bytes.size());
}

}  // namespace

Expected<Bytes> zip(std::span<const MeshFile> files) {
  Bytes out;
  const Archive handle(archive_write_new(), archive_write_free);
  const bool is_open =
      archive_write_set_format_zip(handle.get()) == ARCHIVE_OK &&
      archive_write_set_format_option(handle.get(), "zip", "compression-level", "1") ==
          ARCHIVE_OK &&
      archive_write_set_bytes_in_last_block(handle.get(), 1) == ARCHIVE_OK &&
      archive_write_open(handle.get(), &out, nullptr, append, nullptr) == ARCHIVE_OK;
  if (!is_open) return zip_fault(handle.get());
  for (const MeshFile& file : files) {
    if (!add(handle.get(), file)) return zip_fault(handle.get());
  }
  if (archive_write_close(handle.get()) != ARCHIVE_OK) return zip_fault(handle.get());
  return out;
}

}  // namespace vitrine::inline codec
