// SPDX-License-Identifier: Apache-2.0
// Exported files and posters that are kept ready, the least recently used dropped first. What
// several ask for at once is made once, however their requests are spelt: the others wait for it.
// Where it does not fit, those who have it share it as long as it is being sent.
#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <future>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
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

  // The file under `key`, or else what `make` gives: Expected<std::vector<std::uint8_t>>. Who comes
  // while another makes it gets what that comes to, a fault or an exception too.
  template <class Make>
  Expected<File> find_or_make(const std::string& key, const Make& make) {
    std::promise<Expected<File>> result;
    if (const auto ready = find_or_announce(key, result)) {
      hits.fetch_add(1, std::memory_order_relaxed);
      return ready->get();
    }
    made.fetch_add(1, std::memory_order_relaxed);
    try {
      result.set_value(keep(key, make()));
    } catch (...) {
      result.set_exception(std::current_exception());
    }
    return finish(key);
  }

  std::atomic<std::uint64_t> hits{0}, made{0};

 private:
  struct Entry {
    std::string key;
    File file;
  };
  using Result = std::shared_future<Expected<File>>;

  // What there is or will be; or nothing, and it is the caller who makes it.
  std::optional<Result> find_or_announce(const std::string& key,
                                         std::promise<Expected<File>>& result);
  Expected<File> finish(const std::string& key);  // what has been announced
  Expected<File> keep(const std::string& key, Expected<std::vector<std::uint8_t>> bytes);
  File find_held(const std::string& key);
  void drop_oldest();

  std::mutex mutex_;  // guards what follows
  std::uint64_t max_bytes_;
  std::uint64_t bytes_ = 0;
  std::list<Entry> entries_;  // the most recently used first
  std::unordered_map<std::string, std::list<Entry>::iterator> by_key_;
  std::unordered_map<std::string, std::weak_ptr<const ExportedFile>> large_;  // above the capacity
  std::unordered_map<std::string, Result> in_the_making_;
};

}  // namespace vitrine
