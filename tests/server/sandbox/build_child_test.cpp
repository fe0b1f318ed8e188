// SPDX-License-Identifier: Apache-2.0
#include "server/sandbox/build_child.h"

#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "codec/build/build_model.h"
#include "codec/export/write_mesh.h"
#include "codec/format/manifest.h"
#include "support/as_bytes.h"
#include "support/meshes.h"
#include "support/packages/write_package.h"
#include "support/temporary_folder.h"

namespace vitrine::server {
namespace {

const std::vector<std::uint8_t>& mesh() {
  static const auto bytes =
      write_mesh(test::torus(60, 30), MeshFormat::kPly, {.unit = "mm"}).value();
  return bytes;
}

BuildOrder order() {
  return {.bits = 12, .program = VITRINE_BIN_DIR "/vitrined"};
}

TEST(BuildChild, GivesTheResultOfABuildInThisProcess) {
  const auto built = BuildChild().build(mesh(), order(), {});
  ASSERT_TRUE(built) << built.error().message;
  EXPECT_EQ(built->file, build_model(mesh(), {.bits = 12}, {})->file);
  EXPECT_EQ(built->repairs, "");
}

TEST(BuildChild, ReceivesBitsPlacementAndUpAxis) {
  BuildOrder other = order();
  other.bits = 11;
  other.placement = Placement::kPyramid;
  other.z_is_up = true;
  const auto built = BuildChild().build(mesh(), other, {});
  ASSERT_TRUE(built) << built.error().message;
  EXPECT_EQ(
      built->file,
      build_model(mesh(),
                  {.reading = {.up = UpAxis::kZ}, .bits = 11, .placement = Placement::kPyramid}, {})
          ->file);
}

TEST(BuildChild, TellsWhatItHasRepaired) {
  constexpr std::string_view kTwice = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 3\nf 1 1 2\n";
  const std::span text(reinterpret_cast<const std::uint8_t*>(kTwice.data()), kTwice.size());
  const auto built = BuildChild().build(text, order(), {});
  ASSERT_TRUE(built) << built.error().message;
  const auto here = build_model(text, {}, {});
  std::string expected;
  for (const std::string& line : here->report.input.repairs)
    expected += (expected.empty() ? "" : "\n") + line;
  EXPECT_NE(expected, "");
  EXPECT_EQ(built->repairs, expected);
}

TEST(BuildChild, UnpacksAPackageWithNamesBeyondAscii) {
  const std::string obj = "mtllib b.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n";
  const test::FilesToPack files{{"B\xC3\xBCste/sc\xC3\xA8ne.obj", obj},
                                {"B\xC3\xBCste/b.mtl", "newmtl a\nKd 1 0 0\n"}};
  for (const std::string& package : {test::zip_of(files), test::gzip_of(test::tar_of(files))}) {
    const auto built = BuildChild().build(testing::as_bytes(package), order(), {});
    ASSERT_TRUE(built) << built.error().message;
    EXPECT_EQ(built->file, build_model(testing::as_bytes(package), {.bits = 12}, {})->file);
    EXPECT_NE(built->repairs.find("colours of 1 material baked"), std::string::npos)
        << built->repairs;
  }
}

// Returns an OBJ file and a material library. The materials refer to pictures with these names,
// which do not exist.
std::string package_that_lacks(const std::vector<std::string>& maps) {
  std::string obj = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n", library;
  for (std::size_t i = 0; i < maps.size(); ++i) {
    obj += "usemtl m" + std::to_string(i) + "\nf 1 2 3\n";
    library += "newmtl m" + std::to_string(i) + "\nmap_Kd " + maps[i] + "\n";
  }
  return test::zip_of({{"a.obj", obj}, {"m.mtl", library}});
}

TEST(BuildChild, NamesInNotesKeepTheirLetters) {
  const auto built = BuildChild().build(
      testing::as_bytes(package_that_lacks({"B\xFCste.png", "\xD0\xB1.png", "\x1B[2J.png"})),
      order(), {});
  ASSERT_TRUE(built) << built.error().message;
  for (const std::string_view name : {"'B\xC3\xBCste.png'", "'\xD0\xB1.png'", "'?[2J.png'"})
    EXPECT_NE(built->repairs.find(name), std::string::npos) << built->repairs;
}

TEST(BuildChild, NotesThatDoNotFitAreCounted) {
  std::vector<std::string> maps;
  for (int i = 0; i < 200; ++i)
    maps.push_back("map" + std::to_string(i) + ".png");
  const auto built = BuildChild().build(testing::as_bytes(package_that_lacks(maps)), order(), {});
  ASSERT_TRUE(built) << built.error().message;
  EXPECT_LE(built->repairs.size(), 4096U);
  EXPECT_GT(built->repairs.size(), 3800U);
  const auto shown = std::count(built->repairs.begin(), built->repairs.end(), '\n');
  const auto here = build_model(testing::as_bytes(package_that_lacks(maps)), {}, {});
  const std::string end =
      "\n… and " +
      std::to_string(here->report.input.repairs.size() - static_cast<std::size_t>(shown)) +
      " more; `vitrine build` lists all";
  EXPECT_TRUE(built->repairs.ends_with(end)) << built->repairs;
}

TEST(BuildChild, WhatMaterialsWithoutPicturesLoseIsNoted) {
  const std::string obj =
      "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl glass\nf 1 2 3\nusemtl stone\nf 1 "
      "2 4\n";
  const std::string library = "newmtl glass\nKd 0 1 0\nd 0.3\nnewmtl stone\nKd 1 0 0\n";
  const auto built = BuildChild().build(
      testing::as_bytes(test::zip_of({{"a.obj", obj}, {"m.mtl", library}})), order(), {});
  ASSERT_TRUE(built) << built.error().message;
  EXPECT_NE(
      built->repairs.find("opacity of 1 material not carried: no material has a picture; give "
                          "the materials a texture map"),
      std::string::npos)
      << built->repairs;
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

// Builds with sanitizers omit this test, because their child has no limit on memory.
#ifndef VITRINE_SANITISED
// Returns the text of a file of /proc.
std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

// Returns the limit, in bytes, of the address space of this thread's child process. Returns 0 if it
// is unlimited.
std::uint64_t address_space_of_child() {
  std::uint64_t child = 0, limit = 0;
  std::istringstream(text_of("/proc/thread-self/children")) >> child;
  const std::string limits = text_of("/proc/" + std::to_string(child) + "/limits");
  constexpr std::string_view kName = "Max address space";
  std::istringstream(limits.substr(limits.find(kName) + kName.size())) >> limit;
  return limit;
}

TEST(BuildChild, HasABoundOnItsSpillFileHoweverLargeTheDiskIs) {
  const test::TemporaryFolder folder;
  BuildOrder spilling = order();
  spilling.folder = folder.path();
  std::uint64_t address_space = 0;
  ASSERT_TRUE(BuildChild().build(mesh(), spilling, [&](std::string_view, double) {
    if (address_space == 0) address_space = address_space_of_child();
  }));
  EXPECT_GT(address_space, SandboxLimits().memory_bytes);
  EXPECT_LE(address_space, SandboxLimits().memory_bytes + (16ull << 30));
}
#endif

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
