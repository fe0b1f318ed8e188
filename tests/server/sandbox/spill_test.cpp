// SPDX-License-Identifier: Apache-2.0
#include "server/sandbox/spill.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <map>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "codec/build/build_model.h"
#include "server/sandbox/page_ranges.h"
#include "server/sandbox/sandbox.h"
#include "support/meshes.h"
#include "support/product_names.h"
#include "support/temporary_folder.h"

namespace vitrine::test {
namespace {

using Bytes = std::vector<std::uint8_t>;

TEST(PageRanges, TakenRangesNeverOverlapAndTheLastOneBackLeavesOneFreeRange) {
  constexpr std::size_t kSize = 64 * PageRanges::kPage;
  for (std::uint32_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    PageRanges ranges(kSize);
    std::map<std::size_t, std::size_t> taken;  // offset and end of each range in use
    for (int step = 0; step < 200; ++step) {
      const std::size_t size = 1 + random() % (9 * PageRanges::kPage);
      if (random() % 2 == 0 && !taken.empty()) {
        const auto any = std::next(taken.begin(), random() % taken.size());
        EXPECT_EQ(ranges.give_back(any->first), any->second - any->first);
        taken.erase(any);
      } else if (const auto offset = ranges.take(size)) {
        const std::size_t pages = (size + PageRanges::kPage - 1) / PageRanges::kPage;
        const auto [range, is_new] = taken.emplace(*offset, *offset + pages * PageRanges::kPage);
        ASSERT_TRUE(is_new);
        EXPECT_LE(range->second, std::min(kSize, ranges.end()));
        const auto after = std::next(range);
        EXPECT_TRUE(range == taken.begin() || std::prev(range)->second <= range->first);
        EXPECT_TRUE(after == taken.end() || range->second <= after->first);
      }
    }
    for (const auto& [offset, end] : taken)
      ranges.give_back(offset);
    EXPECT_EQ(ranges.taken(), 0u);
    EXPECT_EQ(ranges.take(kSize), 0u);
    EXPECT_EQ(ranges.take(1), std::nullopt);
  }
}

// A fixture with a folder for the spill file. Its limits are so small that every large block is
// spilled.
struct Spilling {
  TemporaryFolder folder;
  SandboxLimits limits{.spill = {.folder = folder.path(), .resident_bytes = 1}};
};

TEST(Spill, ABuildOutOfCoreGivesTheBytesOfABuildInMemory) {
  const auto input = file_bytes(VITRINE_SOURCE_DIR "/tests/models/demosthenes.obj");
  for (const Placement placement : {Placement::kMidpoint, Placement::kPyramid}) {
    const BuildOptions options{.placement = placement, .region_vertices = 2'000, .threads = 2};
    const auto in_memory = build_model(input, options, {});
    ASSERT_TRUE(in_memory);
    const Spilling spilling;
    std::uint64_t most = 0;
    const auto answer = run_sandboxed(
        spilling.limits,
        [&](const ProgressReport& report) -> Expected<Bytes> {
          std::uint64_t spilled = 0;
          auto built = build_model(input, options, [&](std::string_view stage, double done) {
            spilled = std::max(spilled, spilled_bytes());
            report(stage, done);
          });
          if (!built) return tl::unexpected(built.error());
          report(std::to_string(spilled), 1);
          return std::move(built->file);
        },
        [&](std::string_view stage, double done) {
          EXPECT_TRUE(std::filesystem::is_empty(spilling.folder.path())) << "a file has a name";
          if (done == 1 && stage != "write") most = std::stoull(std::string(stage));
        });
    ASSERT_TRUE(answer) << answer.error().message;
    EXPECT_EQ(*answer, in_memory->file);
    EXPECT_GT(most, 1u << 20);
  }
}

TEST(Spill, UnmappedPagesKeepTheirContent) {
  const Spilling spilling;
  const auto answer = run_sandboxed(spilling.limits, [](const ProgressReport&) -> Expected<Bytes> {
    const std::uint64_t before = mapped_bytes();
    const Bytes large(64 << 20, 7);
    while (mapped_bytes() > before + large.size() / 2)
      std::this_thread::yield();
    return Bytes{static_cast<std::uint8_t>(std::ranges::count(large, 7) == 64 << 20)};
  });
  ASSERT_TRUE(answer) << answer.error().message;
  EXPECT_EQ(*answer, Bytes{1});
}

TEST(Spill, BlocksWithinTheShareOfMemoryDoNotSpill) {
  Spilling spilling;
  spilling.limits.spill.resident_bytes = 64 << 20;
  const auto answer = run_sandboxed(spilling.limits, [](const ProgressReport&) -> Expected<Bytes> {
    const Bytes held(8 << 20);
    const bool none = spilled_bytes() == 0;
    const Bytes beyond(16 << 20);
    const bool some = spilled_bytes() == beyond.size();
    return Bytes{static_cast<std::uint8_t>(none && some)};
  });
  ASSERT_TRUE(answer) << answer.error().message;
  EXPECT_EQ(*answer, Bytes{1});
}

TEST(Spill, MemoryIsUsedIfTheDiskRefusesLargeFiles) {
  struct rlimit before {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const struct rlimit small { .rlim_cur = 1 << 20, .rlim_max = before.rlim_max };
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const Spilling spilling;
  const auto answer = run_sandboxed(spilling.limits, [](const ProgressReport&) -> Expected<Bytes> {
    const Bytes large(8 << 20, 7);
    const bool fits = spill_capacity() <= 1 << 20 && spilled_bytes() == 0;
    return Bytes{static_cast<std::uint8_t>(fits && large.back() == 7)};
  });
  ::setrlimit(RLIMIT_FSIZE, &before);
  ASSERT_TRUE(answer) << answer.error().message;
  EXPECT_EQ(*answer, Bytes{1});
}

TEST(Spill, TheFileGrowsNoLargerThanItsLimitAndTheRestUsesMemory) {
  constexpr std::size_t kMost = 4 << 20;
  Spilling spilling;
  spilling.limits.spill.max_bytes = kMost;
  const auto answer = run_sandboxed(spilling.limits, [](const ProgressReport&) -> Expected<Bytes> {
    const Bytes first(3 << 20, 7), second(3 << 20, 8);
    const bool fits = spill_capacity() == kMost && spilled_bytes() == first.size();
    return Bytes{static_cast<std::uint8_t>(fits && first.back() == 7 && second.back() == 8)};
  });
  ASSERT_TRUE(answer) << answer.error().message;
  EXPECT_EQ(*answer, Bytes{1});
}

TEST(Spill, TheReserveOfTheDiskStaysFree) {
  Spilling spilling;
  const auto capacity = [&] {
    const auto answer = run_sandboxed(spilling.limits, [](const auto&) -> Expected<Bytes> {
      return Bytes{static_cast<std::uint8_t>(spill_capacity() > 0)};
    });
    return answer.value()[0];
  };
  EXPECT_EQ(capacity(), 1);
  spilling.limits.spill.disk_reserve = UINT64_MAX;
  EXPECT_EQ(capacity(), 0);
}

TEST(Spill, HalfOfTheSpaceBeyondTheReserveIsTheCapacity) {
  Spilling spilling;
  const std::uint64_t free = std::filesystem::space(spilling.folder.path()).available;
  // A large value: other programs that write to the disk meanwhile then hardly change the result.
  const std::uint64_t beyond = std::min<std::uint64_t>(free, 1 << 30) / 2;
  spilling.limits.spill.disk_reserve = free - beyond;
  const auto answer = run_sandboxed(spilling.limits, [&](const auto&) -> Expected<Bytes> {
    const std::uint64_t least = beyond / 4, most = beyond / 4 * 3;
    return Bytes{static_cast<std::uint8_t>(least < spill_capacity() && spill_capacity() < most)};
  });
  ASSERT_TRUE(answer) << answer.error().message;
  EXPECT_EQ(*answer, Bytes{1});
}

TEST(Spill, AnUnusableFolderIsNamed) {
  const SandboxLimits limits{.spill = {.folder = "/proc"}};
  const auto answer = run_sandboxed(limits, [](const auto&) { return Bytes{}; });
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().code, ErrorCode::kIo);
  EXPECT_THAT(answer.error().message, ::testing::HasSubstr("cannot make a working file in /proc"));
}

TEST(Spill, ADiskThatFillsUpIsReported) {
  const auto answer = run_sandboxed({}, [](const auto&) -> Expected<Bytes> {
    ::signal(SIGBUS, SIG_DFL);  // replaces the SIGBUS handler that sanitizers install
    ::raise(SIGBUS);
    return Bytes{};
  });
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().code, ErrorCode::kIo);
  EXPECT_THAT(answer.error().message, ::testing::HasSubstr("free some space and try again"));
}

}  // namespace
}  // namespace vitrine::test
