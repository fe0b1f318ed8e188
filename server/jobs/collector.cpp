// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/collector.h"

#include <fmt/core.h>

#include "server/jobs/publish_jobs.h"

namespace vitrine::server {

Expected<std::set<UploadId>> Collector::uploads_in_use() {
  const auto jobs = needs_.jobs.unfinished_jobs();
  if (!jobs) return tl::unexpected(jobs.error());
  std::set<UploadId> uploads;
  for (const JobRecord& job : *jobs) {
    if (const auto upload = PublishJobs::upload_of(job)) uploads.insert(*upload);
  }
  return uploads;
}

Expected<std::size_t> Collector::forget_jobs(std::int64_t now) {
  const auto before = [now](std::chrono::milliseconds age) { return now - age.count(); };
  return needs_.jobs.forget(before(kKeyAge), before(kJobAge));
}

// Removes objects only while it holds the store's lock. Without the lock, it could remove an object
// that another process has just stored but not yet referenced. If the lock is lost, removes no more
// objects.
Expected<Collector::Collected> Collector::collect(std::int64_t now) {
  const auto in_use = uploads_in_use();
  if (!in_use) return tl::unexpected(in_use.error());
  const auto uploads = needs_.uploads.sweep(*in_use, now);
  if (!uploads) return fail(ErrorCode::kIo, uploads.error().message);
  const auto jobs = forget_jobs(now);
  if (!jobs) return tl::unexpected(jobs.error());
  const auto lock = needs_.store.lock();
  if (!lock) return tl::unexpected(lock.error());
  const auto files = needs_.catalogue.files();
  if (!files) return tl::unexpected(files.error());
  std::set<Sha256> named;
  for (const NamedFile& file : *files)
    named.insert(file.file);
  const auto objects = needs_.store.sweep(named, needs_.grace, **lock);
  if (!objects) return tl::unexpected(objects.error());
  return Collected{*objects, *uploads, *jobs};
}

void Collector::collect_and_tell() {
  Expected<Collected> collected;
  try {
    collected = collect();
    // For example std::bad_alloc. Tries again after the next pause.
  } catch (const std::exception& fault) {
    collected = fail(ErrorCode::kIo, std::string("cannot collect: ") + fault.what());
  }
  if (!collected) return needs_.events.event(Severity::kError, collected.error().message);
  if (collected->objects + collected->uploads + collected->jobs == 0) return;
  needs_.events.event(
      Severity::kInfo,
      fmt::format("collected {} unreferenced objects, {} old uploads and {} old jobs",
                  collected->objects, collected->uploads, collected->jobs));
}

void Collector::start(std::chrono::seconds pause) {
  thread_ = std::jthread([this, pause](const std::stop_token& stop) { run(stop, pause); });
}

void Collector::run(const std::stop_token& stop, std::chrono::seconds pause) {
  while (!stop.stop_requested()) {
    collect_and_tell();
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, stop, pause, [this] { return hurries_; });
    hurries_ = false;
  }
}

void Collector::hurry() {
  const std::scoped_lock lock(mutex_);
  hurries_ = true;
  changed_.notify_all();
}

void Collector::stop() {
  thread_ = {};
}

}  // namespace vitrine::server
