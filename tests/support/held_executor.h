// SPDX-License-Identifier: Apache-2.0
// Makes the tasks of a serial executor wait, so that a test can act before they run.
#pragma once

#include <future>

#include "server/jobs/serial_executor.h"
#include "support/product_names.h"

namespace vitrine::test {

// Blocks a serial executor. Tasks posted later wait until let_go() or the destructor is called.
class HeldExecutor {
 public:
  explicit HeldExecutor(SerialExecutor& executor) {
    executor.post([until = go_.get_future().share()] { until.wait(); });
  }
  void let_go() { go_ = {}; }  // destroying the promise ends the wait

 private:
  std::promise<void> go_;
};

}  // namespace vitrine::test
