// SPDX-License-Identifier: Apache-2.0
// Garbage collection. Removes old jobs and idempotency keys, expired uploads, and objects that no
// model refers to. Objects are kept for a grace period first. Several processes may collect in one
// data folder at the same time.
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

namespace vitrine::server {

// All references must outlive the collector.
struct CollectorDependencies {
  ObjectStore& store;
  Catalogue& catalogue;
  JobCatalogue& jobs;
  Uploads& uploads;
  const Log& events;
  std::chrono::seconds grace{3600};  // how long an unreferenced object is kept
};

class Collector {
 public:
  // How long an idempotency key is kept after its job was added, and how long a job is kept after
  // its end. The newest job of a scan is always kept.
  static constexpr std::chrono::days kKeyAge{30}, kJobAge{365};

  explicit Collector(const CollectorDependencies& needs) : needs_(needs) {}

  struct Collected {
    std::size_t objects = 0, uploads = 0, jobs = 0;
  };
  // Collects once and returns the numbers of removed objects, uploads and jobs. `now` is in
  // milliseconds since 1970. Fails with kIo if the catalogue or the disk fails.
  Expected<Collected> collect(std::int64_t now = now_in_milliseconds());

  // Starts a thread that collects at once and then every `pause`, until stop().
  void start(std::chrono::seconds pause);
  // Makes the thread start the next collection without waiting for the rest of the pause.
  void hurry();
  void stop();

 private:
  Expected<std::set<UploadId>> uploads_in_use();
  Expected<std::size_t> forget_jobs(std::int64_t now);
  void collect_and_tell();
  void run(const std::stop_token& stop, std::chrono::seconds pause);

  const CollectorDependencies needs_;
  std::mutex mutex_;  // guards hurries_
  std::condition_variable_any changed_;
  bool hurries_ = false;
  std::jthread thread_;
};

}  // namespace vitrine::server
