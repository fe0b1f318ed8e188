// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/cache_purge.h"

#include <fmt/core.h>

#include <chrono>
#include <thread>

#include "server/remote/remote_server.h"

namespace vitrine::server {
namespace {

constexpr std::chrono::seconds kPurgeDeadline{10};  // time limit of each request
// A purge starts this long after a change of the catalogue, when all daemons have noticed the
// change. If a cache forgot a chunk earlier, it could fetch the chunk again from a daemon that
// still serves the chunk.
constexpr std::chrono::milliseconds kAllHaveNoticed{250};

// Whether the status means that the cache no longer has the chunk. Caches respond with 404 or 412
// if they did not have it.
bool is_forgotten(long status) {
  return status / 100 == 2 || status == 404 || status == 412;
}

// Whether no published model has the chunk. Also returns true if the catalogue cannot be read: a
// cache that wrongly forgets a public chunk only has to fetch the chunk again.
bool is_hidden(const Sha256& chunk, Catalogue& catalogue) {
  const auto place = catalogue.find_chunk(chunk);
  return !place || !*place;
}

}  // namespace

void CachePurge::forget(std::vector<Sha256> chunks) {
  post(std::move(chunks), false);
}

void CachePurge::forget_hidden(std::vector<Sha256> chunks) {
  post(std::move(chunks), true);
}

void CachePurge::post(std::vector<Sha256> chunks, bool only_hidden) {
  const auto noticed = std::chrono::steady_clock::now() + kAllHaveNoticed;
  executor_.post([this, noticed, only_hidden, chunks = std::move(chunks)] {
    if (is_stopping_) return;
    std::this_thread::sleep_until(noticed);
    std::vector<Sha256> purged;
    for (const Sha256& chunk : chunks) {
      if (!is_stopping_ && (!only_hidden || is_hidden(chunk, catalogue_))) purged.push_back(chunk);
    }
    for (const std::string& cache : caches_)
      purge(cache, purged);
  });
}

void CachePurge::stop() {
  is_stopping_ = true;
  executor_.finish();
}

void CachePurge::purge(const std::string& cache, const std::vector<Sha256>& chunks) {
  RemoteServer server;
  for (const Sha256& chunk : chunks) {
    if (is_stopping_) return;
    const auto answer = server.ask({.method = "PURGE",
                                    .url = cache + "/api/v1/chunks/" + to_hex(chunk),
                                    .deadline = kPurgeDeadline,
                                    .given_up = [this] { return is_stopping_.load(); }});
    if (answer && is_forgotten(answer->status)) continue;
    const std::string fault =
        answer ? fmt::format("it responds with {}", answer->status) : answer.error().message;
    return events_.event(
        Severity::kWarning,
        fmt::format("cache {} was not purged: {}; it serves withdrawn chunks for up to 3 minutes, "
                    "longer while no daemon responds, and damaged ones until their file is "
                    "repaired",
                    cache, fault));
  }
  if (!chunks.empty())
    events_.event(Severity::kInfo, fmt::format("cache {}: {} chunks purged", cache, chunks.size()));
}

}  // namespace vitrine::server
