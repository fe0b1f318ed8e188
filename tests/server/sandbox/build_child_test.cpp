// SPDX-License-Identifier: Apache-2.0
#include "server/sandbox/build_child.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "codec/build/build_model.h"
#include "codec/export/write_mesh.h"
#include "codec/format/manifest.h"
#include "support/meshes.h"

namespace vitrine::server {
namespace {

const std::vector<std::uint8_t>& mesh() {
  static const auto bytes = write_mesh(test::torus(60, 30), MeshFormat::kPly, "mm").value();
  return bytes;
}

BuildOrder order() {
  return {.bits = 12, .program = VITRINE_BIN_DIR "/vitrined"};
}

TEST(BuildChild, GivesTheResultOfABuildInThisProcess) {
  const auto built = BuildChild().build(mesh(), order(), {});
  ASSERT_TRUE(built) << built.error().message;
  EXPECT_EQ(*built, build_model(mesh(), {.bits = 12}, {})->file);
}

TEST(BuildChild, ReceivesBitsPlacementAndUpAxis) {
  BuildOrder other = order();
  other.bits = 11;
  other.placement = Placement::kPyramid;
  other.z_is_up = true;
  const auto built = BuildChild().build(mesh(), other, {});
  ASSERT_TRUE(built) << built.error().message;
  EXPECT_EQ(
      *built,
      build_model(mesh(),
                  {.reading = {.up = UpAxis::kZ}, .bits = 11, .placement = Placement::kPyramid}, {})
          ->file);
}

TEST(BuildChild, WorksBesideThreadsThatHoldLocks) {
  std::vector<std::thread> threads;
  std::atomic<bool> done{false};
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&] {
      while (!done)
        std::vector<int>(1'000).shrink_to_fit();
    });
  }
  const auto built = BuildChild().build(mesh(), order(), {});
  done = true;
  for (std::thread& thread : threads)
    thread.join();
  EXPECT_TRUE(built);
}

TEST(BuildChild, ReportsProgress) {
  std::vector<std::string> stages;
  ASSERT_TRUE(BuildChild().build(
      mesh(), order(), [&](std::string_view stage, double) { stages.emplace_back(stage); }));
  ASSERT_FALSE(stages.empty());
  EXPECT_EQ(stages.back(), "write");
}

TEST(BuildChild, AnErrorOfTheBuildIsItsOwn) {
  const std::vector<std::uint8_t> no_mesh(100, 'x');
  const auto built = BuildChild().build(no_mesh, order(), {});
  ASSERT_FALSE(built);
  EXPECT_EQ(built.error().message, build_model(no_mesh, {}, {}).error().message);
}

TEST(BuildChild, StopsInTheMiddleAndStartsNoMore) {
  BuildChild child;
  const auto built = child.build(mesh(), order(), [&](std::string_view, double) { child.stop(); });
  ASSERT_FALSE(built);
  EXPECT_EQ(built.error().code, ErrorCode::kState);
  EXPECT_EQ(child.build(mesh(), order(), {}).error().code, ErrorCode::kState);
}

TEST(BuildChild, AProgramThatIsNotThereIsAnError) {
  BuildOrder missing = order();
  missing.program = VITRINE_BIN_DIR "/absent";
  EXPECT_FALSE(BuildChild().build(mesh(), missing, {}));
}

}  // namespace
}  // namespace vitrine::server
