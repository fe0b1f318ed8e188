// SPDX-License-Identifier: Apache-2.0
// Exported files that are kept ready, the least recently used dropped first. Equal requests run one
// after the other (Place::kExport), so that the second finds what the first has made.
#pragma once

#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>

namespace vitrine {

struct ExportedFile {
  std::vector<std::uint8_t> bytes;
  std::string etag;  // of the bytes, so that another version of the writer is another entity
};

class ExportCache {
 public:
  using File = std::shared_ptr<const ExportedFile>;

  explicit ExportCache(std::uint64_t max_bytes) : max_bytes_(max_bytes) {}

  File find(const std::string& key);  // null where there is none
  // A file above the whole capacity is not kept.
  void insert(const std::string& key, File file);

 private:
  struct Entry {
    std::string key;
    File file;
  };
  void drop_oldest();

  const std::uint64_t max_bytes_;
  std::mutex mutex_;  // guards what follows
  std::uint64_t bytes_ = 0;
  std::list<Entry> entries_;  // the most recently used first
  std::unordered_map<std::string, std::list<Entry>::iterator> by_key_;
};

}  // namespace vitrine
