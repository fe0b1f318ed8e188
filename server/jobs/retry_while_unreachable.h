// SPDX-License-Identifier: Apache-2.0
// Retries an action of a job while the catalogue or the store is unreachable, so that the job's
// result is not lost.
#pragma once

#include <chrono>

#include "server/jobs/job_queue.h"
#include "server/store/backoff.h"

namespace vitrine::server {

inline constexpr std::chrono::minutes kRetryTimeout{2};

// Repeats `action` while it fails with kIo, for at most kRetryTimeout or until the job is asked to
// stop. Returns the last result.
template <class Action>
auto retry_while_unreachable(const JobRun& run, Action action, const Backoff& backoff = {})
    -> decltype(action()) {
  const auto deadline = std::chrono::steady_clock::now() + kRetryTimeout;
  for (int failures = 1;; ++failures) {
    auto result = action();
    const bool is_away = !result && result.error().code == ErrorCode::kIo;
    const bool may_wait =
        run.stop_request() == StopRequest::kNone && std::chrono::steady_clock::now() < deadline;
    if (!is_away || !may_wait) return result;
    backoff.wait(failures);
  }
}

}  // namespace vitrine::server
