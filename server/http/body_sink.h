// SPDX-License-Identifier: Apache-2.0
// Where the body of a request goes that is too large for memory.
#pragma once

#include <optional>
#include <span>

#include "server/http/response.h"

namespace vitrine {

// Called on a worker thread, one call at a time.
class BodySink {
 public:
  virtual ~BodySink() = default;

  // The next piece. An answer is the end of it: what would come after it is not read.
  virtual std::optional<Response> take(std::span<const std::uint8_t> piece) = 0;

  // No more pieces come: the body is whole, or who sends it is gone and hears no answer.
  virtual Response finish() = 0;
};

}  // namespace vitrine
