// SPDX-License-Identifier: Apache-2.0
// Asks the shared caches in front of the daemon to forget chunks that are no longer public, and
// chunks whose cached copies may be damaged. Sends requests with the method PURGE. This method is
// not standardised, but Varnish, Squid and the nginx configuration shipped with Vitrine support it.
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

  // Sends PURGE {cache}/api/v1/chunks/{sha256} to each cache, on another thread, for each of the
  // chunks. If a cache refuses a request, logs a warning and sends the remaining requests to the
  // other caches only.
  void forget(std::vector<Sha256> chunks);
  // Like forget(), but skips chunks that belong to a published model.
  void forget_hidden(std::vector<Sha256> chunks);

  // Ends the thread and drops the chunks whose requests have not been sent. Call this before the
  // catalogue is destroyed.
  void stop();

 private:
  void post(std::vector<Sha256> chunks, bool only_hidden);
  void purge(const std::string& cache, const std::vector<Sha256>& chunks);

  const std::vector<std::string> caches_;
  Catalogue& catalogue_;
  std::atomic<bool> is_stopping_{false};
  const Log& events_;
  SerialExecutor executor_;
};

}  // namespace vitrine::server
