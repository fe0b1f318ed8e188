// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/scrubber.h"

#include <fmt/core.h>

#include <algorithm>
#include <random>

#include "server/jobs/clock.h"
#include "server/store/file_object.h"

namespace vitrine::server {

void Scrubber::start(std::uint64_t rate) {
  if (rate > 0) rate_ = rate;
  thread_ = std::jthread([this, makes_passes = rate > 0] {
    for (auto next = makes_passes ? Clock::now() : Clock::time_point::max();;) {
      try {
        if (Clock::now() >= next) {
          const auto begun = Clock::now();
          next = begun + (check_all() ? Clock::duration(kEvery) : Clock::duration(kRetryAfter));
        } else {
          check_damaged();
        }
      } catch (const std::exception& fault) {  // such as std::bad_alloc; continues after the pause
        needs_.events.event(Severity::kError, fault.what());
      }
      if (!wait_until(std::min(next, Clock::now() + kRetryAfter))) return;
    }
  });
}

void Scrubber::stop() {
  stopping_.request_stop();
  thread_ = {};
}

// Starts at a random object, so that a daemon that restarts often still checks all objects over
// time.
bool Scrubber::check_all() {
  check_catalogue();
  auto files = distinct_files(needs_.catalogue);
  if (!files) {
    needs_.events.event(Severity::kWarning, "cannot check the objects: " + files.error().message);
    return false;
  }
  if (!files->empty()) {
    std::random_device random;
    const auto first = static_cast<std::ptrdiff_t>(random() % files->size());
    std::rotate(files->begin(), files->begin() + first, files->end());
  }
  const auto done = scrub(
      needs_.store, *files, [this](std::uint64_t count) { return pace(count); },
      [this](const NamedFile& file, ObjectState state) { take(file, state); });
  if (stopping_.stop_requested()) return false;
  if (!done) {
    needs_.events.event(Severity::kWarning, "cannot check the objects: " + done.error().message);
    return false;
  }
  finished = now_in_milliseconds() / 1000;
  return true;
}

void Scrubber::check_catalogue() {
  const auto faults = needs_.catalogue_faults();
  if (!faults) return needs_.events.event(Severity::kWarning, faults.error().message);
  catalogue_faults = faults->size();
  for (const std::string& fault : *faults) {
    needs_.events.event(Severity::kError,
                        fmt::format("the catalogue is damaged: {}; restore a backup", fault));
  }
}

void Scrubber::take(const NamedFile& file, ObjectState state) {
  ++objects;
  if (state == ObjectState::kIntact) {
    if (has_damaged_copy(file.file)) drop_copies(file.file);
    needs_.models.set_intact(file.file);
  } else if (is_named(file.file)) {
    needs_.models.set_damaged(file.file);
    forget_copies(file.file);
    needs_.events.event(Severity::kError,
                        to_text(DamagedFile{file, state}) +
                            "; put it back with 'vitrine repair', or publish the model again");
  }
  if (Clock::now() >= next_retry_) check_damaged();
}

bool Scrubber::has_damaged_copy(const Sha256& file) {
  if (!needs_.store.keeps_copies()) return false;
  const auto open = needs_.models.open_with(file);
  return std::ranges::any_of(open, [&](const auto& model) {
    return !is_intact_on_disk(model->file(), file, [this](std::uint64_t count) {
      return pace(count);
    }) && !stopping_.stop_requested();
  });
}

// Closes the local copies of an object. The next request makes a new copy.
void Scrubber::drop_copies(const Sha256& file) {
  needs_.models.drop_copies(file);
  forget_copies(file);
  needs_.events.event(
      Severity::kError,
      fmt::format("the local copy of object {} was damaged and is loaded again; check the disk",
                  to_hex(file)));
}

void Scrubber::check_damaged() {
  next_retry_ = Clock::now() + kRetryAfter;
  for (const Sha256& file : needs_.models.damaged()) {
    const auto state =
        needs_.store.check(file, [this](std::uint64_t count) { return pace(count); });
    if (!state) return;  // the store is unreachable, or stop() was called
    if (*state != ObjectState::kIntact && is_named(file)) continue;
    needs_.models.set_intact(file);
    if (*state == ObjectState::kIntact)
      needs_.events.event(Severity::kInfo, fmt::format("object {} is intact again", to_hex(file)));
  }
}

// Whether a model refers to the file. Returns true if the catalogue cannot be read.
bool Scrubber::is_named(const Sha256& file) {
  const auto files = needs_.catalogue.files();
  return !files || std::ranges::count(*files, file, &NamedFile::file) > 0;
}

// Calls `forget` with the public blocks of each model that refers to the file.
void Scrubber::forget_copies(const Sha256& file) {
  if (!needs_.forget) return;
  const auto files = needs_.catalogue.files();
  if (!files) return needs_.events.event(Severity::kWarning, files.error().message);
  for (const NamedFile& named : *files) {
    if (named.file != file) continue;
    auto chunks = needs_.catalogue.public_chunks(named.model);
    if (!chunks) return needs_.events.event(Severity::kWarning, chunks.error().message);
    if (!chunks->empty()) needs_.forget(std::move(*chunks));
  }
}

// Counts the bytes, and waits until more bytes may be read. Returns false if stop() was called.
bool Scrubber::pace(std::uint64_t count) {
  bytes += count;
  const std::chrono::duration<double> cost(static_cast<double>(count) / static_cast<double>(rate_));
  next_piece_ =
      std::max(next_piece_, Clock::now()) + std::chrono::duration_cast<Clock::duration>(cost);
  return wait_until(next_piece_);
}

bool Scrubber::wait_until(Clock::time_point time) {
  if (needs_.wait_until) return needs_.wait_until(time);
  std::unique_lock lock(mutex_);
  pause_.wait_until(lock, stopping_.get_token(), time, [] { return false; });
  return !stopping_.stop_requested();
}

}  // namespace vitrine::server
