// SPDX-License-Identifier: Apache-2.0
// Garbage collection: what no model, upload or unfinished job names is taken away after a grace,
// and what is of old times after ages. Any number of processes may do so on one data folder at a
// time.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <set>
#include <thread>

#include "server/catalogue/catalogue.h"
#include "server/catalogue/jobs.h"
#include "server/jobs/clock.h"
#include "server/log/log.h"
#include "server/store/object_store.h"
#include "server/store/uploads.h"

namespace vitrine {

// All of it outlives the collector.
struct CollectorMeans {
  ObjectStore& store;
  Catalogue& catalogue;
  JobCatalogue& jobs;
  Uploads& uploads;
  const Log& events;
  std::chrono::seconds grace{3600};  // that an object stays which nothing names
};

class Collector {
 public:
  // How long an Idempotency-Key is known after its job has begun, and a job after it has ended,
  // unless it is the newest of a scan.
  static constexpr std::chrono::days kKeyAge{30}, kJobAge{365};

  explicit Collector(const CollectorMeans& means) : means_(means) {}

  struct Collected {
    std::size_t objects = 0, uploads = 0, jobs = 0;
  };
  // `now` in milliseconds since 1970. Fails (kIo) where the catalogue or the disk refuses.
  Expected<Collected> collect(std::int64_t now = now_in_milliseconds());

  // Collects once and then each time that `pause` has gone, on a thread of its own, until stop().
  void start(std::chrono::seconds pause);
  // Collects soon.
  void hurry();
  void stop();

 private:
  Expected<std::set<UploadId>> uploads_in_use();
  Expected<std::size_t> forget_jobs(std::int64_t now);
  void collect_and_tell();
  void run(const std::stop_token& stop, std::chrono::seconds pause);

  const CollectorMeans means_;
  std::mutex mutex_;  // guards what follows
  std::condition_variable_any changed_;
  bool hurries_ = false;
  std::jthread thread_;
};

}  // namespace vitrine
