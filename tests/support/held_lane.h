// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <future>

#include "server/jobs/lane.h"

namespace vitrine::test {

// Keeps a lane from what is handed in after this, until it is let go or this is gone.
class HeldLane {
 public:
  explicit HeldLane(Lane& lane) {
    lane.post([until = go_.get_future().share()] { until.wait(); });
  }
  void let_go() { go_ = {}; }  // who waits for a promise that is gone waits no more

 private:
  std::promise<void> go_;
};

}  // namespace vitrine::test
