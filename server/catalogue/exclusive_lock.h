// SPDX-License-Identifier: Apache-2.0
// A lock that has at most one holder at a time among all processes that use an installation.
#pragma once

#include "codec/core/expected.h"

namespace vitrine::server {

// A lock that is held from its creation until the object is destroyed.
class ExclusiveLock {
 public:
  virtual ~ExclusiveLock() = default;

  // Succeeds if the lock is still held. Fails with kIo if the lock was lost. The caller must then
  // stop its work, because another process may hold the lock.
  virtual Expected<void> check() const = 0;
};

}  // namespace vitrine::server
