// SPDX-License-Identifier: Apache-2.0
// Asks the shared caches in front of the daemon to forget chunks that are no longer public. Sends
// the method PURGE, which has no standard; Varnish, Squid and the shipped configuration of nginx
// know it.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "server/catalogue/catalogue.h"
#include "server/jobs/serial_executor.h"
#include "server/log/log.h"

namespace vitrine::server {

// Thread-safe.
class CachePurge {
 public:
  // `caches`: the URL of each cache, without a slash at its end.
  CachePurge(std::vector<std::string> caches, Catalogue& catalogue, const Log& events)
      : caches_(std::move(caches)), catalogue_(catalogue), events_(events), executor_(events) {}
  ~CachePurge() { stop(); }

  // Sends PURGE {cache}/api/v1/chunks/{sha256} to each cache, on another thread, for each chunk
  // that no published model has. If a cache refuses one of these requests, logs a warning and sends
  // the rest to the other caches only.
  void forget(std::vector<Sha256> chunks);

  // Drops the chunks that wait. Call it before the catalogue is destroyed.
  void stop();

 private:
  void purge(const std::string& cache, const std::vector<Sha256>& chunks);

  const std::vector<std::string> caches_;
  Catalogue& catalogue_;
  std::atomic<bool> is_stopping_{false};
  const Log& events_;
  SerialExecutor executor_;
};

}  // namespace vitrine::server
