// SPDX-License-Identifier: Apache-2.0
// Checks all stored objects and the catalogue for damage in the background, at a limited rate.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "server/catalogue/catalogue.h"
#include "server/log/log.h"
#include "server/store/object_store.h"
#include "server/store/published_model.h"
#include "server/store/scrub.h"

namespace vitrine::server {

// All references must outlive the scrubber.
struct ScrubberDependencies {
  const ObjectStore& store;
  Catalogue& catalogue;
  PublishedModels& models;
  // Returns the faults of the catalogue, as find_catalogue_faults() does.
  std::function<Expected<std::vector<std::string>>()> catalogue_faults;
  const Log& events;
  // Asks shared caches to forget the blocks of a damaged file, because their copies may be damaged,
  // too. Empty if there are no shared caches.
  std::function<void(std::vector<Sha256> chunks)> forget = {};
  // Waits until the given time and returns whether to continue. If this function is empty, the
  // scrubber itself waits, at most until stop() is called. Tests set it to count the waits.
  std::function<bool(std::chrono::steady_clock::time_point)> wait_until = {};
};

class Scrubber {
 public:
  // Time from the start of one pass to the start of the next.
  static constexpr std::chrono::hours kEvery{7 * 24};
  // A damaged object is checked again after this time, to find out whether it has been repaired. A
  // pass that failed starts again after this time.
  static constexpr std::chrono::minutes kRetryAfter{10};
  static constexpr std::uint64_t kDefaultRate = 8'000'000;  // bytes per second

  explicit Scrubber(const ScrubberDependencies& needs) : needs_(needs) {}
  ~Scrubber() { stop(); }

  // Starts a thread that makes a pass at once and then every kEvery, and reads at most `rate` bytes
  // per second. If `rate` is 0, makes no passes and only checks damaged objects again. Call this
  // once.
  void start(std::uint64_t rate);
  void stop();

  // Makes one pass: checks the catalogue, every object that it names, and the local copies of
  // cached models. Withdraws damaged objects from the cache of models and from shared caches, and
  // logs them. Returns false if the pass could not be completed.
  bool check_all();

  // Checks the known damaged objects again. An object that is intact now, or that no model refers
  // to, no longer counts as damaged.
  void check_damaged();

  std::atomic<std::uint64_t> objects{0}, bytes{0};  // objects and bytes checked since the start
  // number of faults found in the last check of the catalogue
  std::atomic<std::uint64_t> catalogue_faults{0};
  // end of the last complete pass, in seconds since 1970; 0 if there was none
  std::atomic<std::int64_t> finished{0};

 private:
  using Clock = std::chrono::steady_clock;

  void check_catalogue();
  void take(const NamedFile& file, ObjectState state);
  bool has_damaged_copy(const Sha256& file);
  void drop_copies(const Sha256& file);
  bool pace(std::uint64_t count);
  bool wait_until(Clock::time_point time);  // returns false if stop() was called
  bool is_named(const Sha256& file);
  void forget_copies(const Sha256& file);

  const ScrubberDependencies needs_;
  std::uint64_t rate_ = kDefaultRate;  // bytes per second
  Clock::time_point next_piece_{};
  Clock::time_point next_retry_ = Clock::now() + kRetryAfter;
  std::stop_source stopping_;
  std::mutex mutex_;
  std::condition_variable_any pause_;
  std::jthread thread_;
};

}  // namespace vitrine::server
