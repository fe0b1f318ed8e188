// SPDX-License-Identifier: Apache-2.0
// Exported files and posters that are kept ready, the least recently used dropped first. Equal
// requests run one after the other (Place::kExport), so that the second finds what the first has
// made; where that does not fit, the two share it as long as it is being sent.
#pragma once

#include <atomic>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>

#include "codec/core/expected.h"

namespace vitrine {

struct ExportedFile {
  std::vector<std::uint8_t> bytes;
  std::string etag;  // of the bytes, so that another version of the writer is another entity
};

class ExportCache {
 public:
  using File = std::shared_ptr<const ExportedFile>;

  explicit ExportCache(std::uint64_t max_bytes) : max_bytes_(max_bytes) {}

  std::uint64_t bytes();  // held
  void set_capacity(std::uint64_t max_bytes);

  File find(const std::string& key);  // null where there is none
  // A file above the whole capacity is found only as long as somebody holds it.
  void insert(const std::string& key, File file);

  // The file under `key`, or else what `make` gives: Expected<std::vector<std::uint8_t>>.
  template <class Make>
  Expected<File> find_or_make(const std::string& key, const Make& make) {
    if (File file = find(key)) {
      hits.fetch_add(1, std::memory_order_relaxed);
      return file;
    }
    made.fetch_add(1, std::memory_order_relaxed);
    auto bytes = make();
    if (!bytes) return Unexpected(bytes.error());
    return keep(key, std::move(*bytes));
  }

  std::atomic<std::uint64_t> hits{0}, made{0};

 private:
  struct Entry {
    std::string key;
    File file;
  };
  File keep(const std::string& key, std::vector<std::uint8_t> bytes);
  void drop_oldest();

  std::mutex mutex_;  // guards what follows
  std::uint64_t max_bytes_;
  std::uint64_t bytes_ = 0;
  std::list<Entry> entries_;  // the most recently used first
  std::unordered_map<std::string, std::list<Entry>::iterator> by_key_;
  std::unordered_map<std::string, std::weak_ptr<const ExportedFile>> large_;  // above the capacity
};

}  // namespace vitrine
