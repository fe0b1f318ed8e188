// SPDX-License-Identifier: Apache-2.0
// Takes the value of a result, or ends the benchmark with its error.
#pragma once

#include <stdexcept>

#include "codec/core/expected.h"

namespace vitrine::bench {

// Returns the value. Throws the error if there is none, because a benchmark with a failed part has
// no results.
template <class T>
T value_of(Expected<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return std::move(*result);
}

}  // namespace vitrine::bench
