// SPDX-License-Identifier: Apache-2.0
// Expects a level's stated error to be a bound, and close to the true one.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "codec/distance/error_meter.h"
#include "support/dense_distance.h"
#include "support/product_names.h"

namespace vitrine::test {

inline void expect_tight(const LevelError& error, const TriangleMesh& level,
                         const TriangleMesh& original) {
  const double bound = error.max_error;
  const double there = dense_maximum(level, TriangleBvh(original));
  const double back = dense_maximum(original, TriangleBvh(level));
  EXPECT_GE(bound, std::max(there, back) * (1 - 1e-9));
  EXPECT_LE(bound, std::max(there, back) * 1.06);
}

inline void expect_tight(const TriangleMesh& level, const TriangleMesh& original) {
  expect_tight(ErrorMeter(original).measure(level), level, original);
}

}  // namespace vitrine::test
