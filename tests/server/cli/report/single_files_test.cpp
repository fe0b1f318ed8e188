// SPDX-License-Identifier: Apache-2.0
#include "server/cli/report/single_files.h"

#include <gtest/gtest.h>

#include "codec/export/write_drc.h"
#include "support/meshes.h"
#include "support/product_names.h"

namespace vitrine::test {
namespace {

const auto kQuietly = [](double) {};

TEST(SingleFiles, MoreBytesBuyLessError) {
  const auto files = single_files(sheet(60, 60), 100, 12, kQuietly);
  ASSERT_GE(files.size(), 6u);
  for (std::size_t i = 1; i < files.size(); ++i) {
    EXPECT_GT(files[i].bytes, files[i - 1].bytes);
    EXPECT_LT(files[i].rms_error, files[i - 1].rms_error);
  }
}

TEST(SingleFiles, TheLastOneIsTheWholeMeshAsDracoHasIt) {
  const TriangleMesh mesh = sheet(60, 60);
  const auto files = single_files(mesh, 100, 12, kQuietly);
  const TriangleMesh rounded = to_model(quantise(mesh, fit_lattice(mesh.positions, 12)));
  const auto drc = write_drc(rounded, {.bits = 12, .effort = 10});
  ASSERT_TRUE(drc.has_value()) << drc.error().message;
  EXPECT_EQ(files.back().bytes, drc->size());
  EXPECT_LT(files.back().rms_error, fit_lattice(mesh.positions, 12).step);
}

TEST(SingleFiles, ColoursTravel) {
  TriangleMesh mesh = sheet(40, 40);
  const auto plain = single_files(mesh, 100, 10, kQuietly);
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v)
    mesh.attributes.colours.push_back(
        {static_cast<std::uint8_t>(v * 37), static_cast<std::uint8_t>(v), 90});
  EXPECT_GT(single_files(mesh, 100, 10, kQuietly).back().bytes, plain.back().bytes * 3 / 2);
}

TEST(SingleFiles, ASingleTriangleIsNoReasonToFail) {
  const TriangleMesh mesh{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .faces = {{0, 1, 2}}};
  EXPECT_LE(single_files(mesh, 1, 10, kQuietly).size(), 1u);
}

}  // namespace
}  // namespace vitrine::test
