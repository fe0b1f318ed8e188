// SPDX-License-Identifier: Apache-2.0
// A cache of exported files and posters that drops the least recently used file first. If several
// requests need the same file at the same time, the file is made once and all requests get it. The
// cache does not keep a file larger than its capacity, but requests can share such a file as long
// as one of them is sending it.
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

namespace vitrine::server {

struct ExportedFile {
  std::vector<std::uint8_t> bytes;
  // A hash of the bytes, used as entity tag. If a new version of the writer produces other bytes,
  // the tag changes.
  std::string etag;
};

class ExportCache {
 public:
  using File = std::shared_ptr<const ExportedFile>;

  explicit ExportCache(std::uint64_t max_bytes) : max_bytes_(max_bytes) {}

  std::uint64_t bytes();  // returns the size of the cached files in bytes
  void set_capacity(std::uint64_t max_bytes);
  bool keeps_files();  // whether the capacity is more than 0

  File find(const std::string& key);  // returns null if the file is not cached
  // Adds a file. find() returns a file larger than the capacity only as long as some caller holds
  // it.
  void insert(const std::string& key, File file);

  // Returns the file under `key`. If there is none, calls `make`, which returns
  // Expected<std::vector<std::uint8_t>>. If several callers need a key at the same time, one of
  // them calls `make`. The other callers wait and get the same result, even if it is an error or an
  // exception.
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

  // Returns the cached file, or a future of the file that another caller is making. Returns nullopt
  // if the caller must make the file itself.
  std::optional<Result> find_or_announce(const std::string& key,
                                         std::promise<Expected<File>>& result);
  // Called after the file under `key` was made. Removes the key's entry from in_the_making_ and
  // returns the result.
  Expected<File> finish(const std::string& key);
  Expected<File> keep(const std::string& key, Expected<std::vector<std::uint8_t>> bytes);
  File find_held(const std::string& key);
  void drop_oldest();

  std::mutex mutex_;  // guards the members below
  std::uint64_t max_bytes_;
  std::uint64_t bytes_ = 0;
  std::list<Entry> entries_;  // most recently used first
  std::unordered_map<std::string, std::list<Entry>::iterator> by_key_;
  // Files larger than the capacity. An entry is usable only as long as some caller holds the file.
  std::unordered_map<std::string, std::weak_ptr<const ExportedFile>> large_;
  std::unordered_map<std::string, Result> in_the_making_;
};

}  // namespace vitrine::server
