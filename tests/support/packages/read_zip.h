// SPDX-License-Identifier: Apache-2.0
// Reads zip archives.
#pragma once

#include <archive.h>
#include <archive_entry.h>

#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

namespace vitrine::test {

// Returns the files of a zip archive by name. Throws std::runtime_error if it is damaged.
inline std::map<std::string, std::string> read_zip(std::string_view bytes) {
  const std::unique_ptr<archive, decltype(&archive_read_free)> handle(archive_read_new(),
                                                                      archive_read_free);
  archive_read_support_format_zip(handle.get());
  const auto check = [&](bool is_good) {
    if (!is_good) throw std::runtime_error(archive_error_string(handle.get()));
  };
  check(archive_read_open_memory(handle.get(), bytes.data(), bytes.size()) == ARCHIVE_OK);
  std::map<std::string, std::string> files;
  archive_entry* entry = nullptr;
  int found = ARCHIVE_OK;
  while ((found = archive_read_next_header(handle.get(), &entry)) == ARCHIVE_OK) {
    std::string& file = files[archive_entry_pathname(entry)];
    char block[4096];
    la_ssize_t count = 0;
    while ((count = archive_read_data(handle.get(), block, sizeof block)) > 0)
      file.append(block, static_cast<std::size_t>(count));
    check(count == 0);
  }
  check(found == ARCHIVE_EOF);
  return files;
}

}  // namespace vitrine::test
