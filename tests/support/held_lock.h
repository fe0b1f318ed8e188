// SPDX-License-Identifier: Apache-2.0
// A lock that a test holds until a chosen number of checks.
#pragma once

#include <atomic>
#include <memory>

#include "server/catalogue/exclusive_lock.h"
#include "support/product_names.h"

namespace vitrine::test {

// A lock that is lost after a given number of checks.
class HeldLock final : public ExclusiveLock {
 public:
  explicit HeldLock(int checks = 1'000'000) : left_(checks) {}
  Expected<void> check() const override {
    if (left_-- > 0) return {};
    return fail(ErrorCode::kIo, "the lock is lost; try again");
  }

 private:
  mutable std::atomic<int> left_;
};

inline const HeldLock kHeld;

}  // namespace vitrine::test
