// SPDX-License-Identifier: Apache-2.0
// Turns errors of the codec into exceptions. A benchmark of a broken codec has no results.
#pragma once

#include <stdexcept>
#include <utility>

#include "codec/core/expected.h"

namespace vitrine::bench {

template <class T>
T checked(Expected<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return std::move(*result);
}

inline void checked(const Expected<void>& result) {
  if (!result) throw std::runtime_error(result.error().message);
}

}  // namespace vitrine::bench
