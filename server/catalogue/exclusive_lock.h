// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "codec/core/expected.h"

namespace vitrine {

// What one at a time of all who use an installation holds, until it is gone.
class ExclusiveLock {
 public:
  virtual ~ExclusiveLock() = default;

  // Fails (kIo) once it has been lost, and another may hold it: what was about to be done is not to
  // be done.
  virtual Expected<void> check() const = 0;
};

}  // namespace vitrine
