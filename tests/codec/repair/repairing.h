// SPDX-License-Identifier: Apache-2.0
// Repairs a mesh, and checks all properties that repair() guarantees for every mesh.
#pragma once

#include <gtest/gtest.h>

#include <utility>

#include "codec/mesh/connectivity.h"
#include "codec/repair/notes.h"
#include "codec/repair/repair.h"

namespace vitrine::testing {

inline RepairedMesh repaired(ImportedMesh imported) {
  auto result = repair(std::move(imported));
  EXPECT_TRUE(result.has_value()) << result.error().message;
  if (!result) return {};
  expect_counts_and_steps(result->repairs);
  const auto closed = Connectivity::close(static_cast<std::uint32_t>(result->mesh.positions.size()),
                                          result->mesh.faces);
  EXPECT_TRUE(closed.has_value()) << closed.error().message;
  return *std::move(result);
}

inline RepairedMesh repaired(TriangleMesh mesh) {
  return repaired(ImportedMesh{std::move(mesh), {}});
}

}  // namespace vitrine::testing
