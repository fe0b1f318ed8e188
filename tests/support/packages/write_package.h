// SPDX-License-Identifier: Apache-2.0
// Writes zip, tar and gzip packages.
#pragma once

#include <archive.h>
#include <archive_entry.h>
#include <zlib.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "codec/package/utf8_names.h"

namespace vitrine::test {

// Names and contents, in the order in which they are packed.
using FilesToPack = std::vector<std::pair<std::string, std::string>>;

inline la_ssize_t append_to_text(archive*, void* out, const void* bytes, std::size_t size) {
  static_cast<std::string*>(out)->append(static_cast<const char*>(bytes), size);
  return static_cast<la_ssize_t>(size);
}

// Returns a package of the format that libarchive calls `format`, such as "zip", "gnutar" or "pax".
// `options` are those of libarchive, such as "zip:compression=store".
inline std::string package_of(const FilesToPack& files, const char* format,
                              const char* options = nullptr) {
  const Utf8Names names;
  const std::unique_ptr<archive, decltype(&archive_write_free)> handle(archive_write_new(),
                                                                       archive_write_free);
  std::string out;
  const auto check = [&](int result) {
    if (result != ARCHIVE_OK) throw std::runtime_error(archive_error_string(handle.get()));
  };
  check(archive_write_set_format_by_name(handle.get(), format));
  check(archive_write_set_options(handle.get(), options));
  check(archive_write_set_bytes_in_last_block(handle.get(), 1));
  check(archive_write_open(handle.get(), &out, nullptr, append_to_text, nullptr));
  for (const auto& [name, contents] : files) {
    const std::unique_ptr<archive_entry, decltype(&archive_entry_free)> entry(archive_entry_new(),
                                                                              archive_entry_free);
    archive_entry_set_pathname(entry.get(), name.c_str());
    archive_entry_set_size(entry.get(), static_cast<la_int64_t>(contents.size()));
    archive_entry_set_filetype(entry.get(), AE_IFREG);
    archive_entry_set_perm(entry.get(), 0644);
    check(archive_write_header(handle.get(), entry.get()));
    archive_write_data(handle.get(), contents.data(), contents.size());
  }
  check(archive_write_close(handle.get()));
  return out;
}

inline std::string zip_of(const FilesToPack& files) {
  return package_of(files, "zip");
}

inline std::string tar_of(const FilesToPack& files) {
  return package_of(files, "gnutar");
}

inline std::string gzip_of(std::string_view contents) {
  constexpr int kGzip = 16 + MAX_WBITS;
  z_stream stream{};
  deflateInit2(&stream, 9, Z_DEFLATED, kGzip, 8, Z_DEFAULT_STRATEGY);
  std::string out(deflateBound(&stream, contents.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(contents.data()));
  stream.avail_in = static_cast<uInt>(contents.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

}  // namespace vitrine::test
