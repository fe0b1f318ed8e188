// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/build_child.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "codec/export/write_mesh.h"
#include "codec/progressive/manifest.h"
#include "server/jobs/build_model.h"
#include "support/meshes.h"

namespace vitrine {
namespace {

const std::vector<std::uint8_t>& mesh() {
  static const auto bytes = write_mesh(test::torus(60, 30), MeshFormat::kPly, "mm").value();
  return bytes;
}

BuildOrder order() {
  return {.bits = 12, .program = VITRINE_BIN_DIR "/vitrined"};
}

TEST(BuildChild, gives_what_a_build_in_this_process_gives) {
  const auto built = BuildChild().build(mesh(), order(), {});
  ASSERT_TRUE(built) << built.error().message;
  EXPECT_EQ(*built, build_model(mesh(), {.bits = 12}, {})->file);
}

TEST(BuildChild, is_told_bits_placement_and_which_way_is_up) {
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

TEST(BuildChild, works_beside_threads_that_hold_locks) {
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

TEST(BuildChild, tells_how_far_it_is) {
  std::vector<std::string> stages;
  ASSERT_TRUE(BuildChild().build(
      mesh(), order(), [&](std::string_view stage, double) { stages.emplace_back(stage); }));
  ASSERT_FALSE(stages.empty());
  EXPECT_EQ(stages.back(), "write");
}

TEST(BuildChild, an_error_of_the_build_is_its_own) {
  const std::vector<std::uint8_t> no_mesh(100, 'x');
  const auto built = BuildChild().build(no_mesh, order(), {});
  ASSERT_FALSE(built);
  EXPECT_EQ(built.error().message, build_model(no_mesh, {}, {}).error().message);
}

TEST(BuildChild, stops_in_the_middle_and_starts_no_more) {
  BuildChild child;
  const auto built = child.build(mesh(), order(), [&](std::string_view, double) { child.stop(); });
  ASSERT_FALSE(built);
  EXPECT_EQ(built.error().code, ErrorCode::kState);
  EXPECT_EQ(child.build(mesh(), order(), {}).error().code, ErrorCode::kState);
}

TEST(BuildChild, a_program_that_is_not_there_is_an_error) {
  BuildOrder missing = order();
  missing.program = VITRINE_BIN_DIR "/absent";
  EXPECT_FALSE(BuildChild().build(mesh(), missing, {}));
}

}  // namespace
}  // namespace vitrine
