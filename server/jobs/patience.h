// SPDX-License-Identifier: Apache-2.0
// What a job has made is not lost because the catalogue or the store is away for a while.
#pragma once

#include <chrono>

#include "server/jobs/job_queue.h"
#include "server/store/backoff.h"

namespace vitrine {

inline constexpr std::chrono::minutes kPatienceOfJobs{2};

// Does `action`, and again while it fails with kIo, for two minutes or until something is wished of
// the job; its last result.
template <class Action>
auto patiently(const JobRun& run, Action action, const Backoff& backoff = {})
    -> decltype(action()) {
  const auto deadline = std::chrono::steady_clock::now() + kPatienceOfJobs;
  for (int failures = 1;; ++failures) {
    auto result = action();
    const bool is_away = !result && result.error().code == ErrorCode::kIo;
    const bool may_wait =
        run.wish() == JobWish::kNone && std::chrono::steady_clock::now() < deadline;
    if (!is_away || !may_wait) return result;
    backoff.wait(failures);
  }
}

}  // namespace vitrine
