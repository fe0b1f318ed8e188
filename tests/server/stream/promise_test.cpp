// SPDX-License-Identifier: Apache-2.0
// Tests the detail request WantSeconds over a slow link: a client asks for the detail that can
// arrive within a given time. The server promises a number of bytes, which must arrive within that
// time.
#include <gtest/gtest.h>

#include <deque>
#include <functional>
#include <map>

#include "server/stream/stream_state.h"

namespace vitrine::server {
namespace {

constexpr std::uint64_t kHeadBytes = 1'000;

// Returns a manifest whose levels have one region and one chunk each.
Manifest manifest_of(std::uint32_t levels, std::uint64_t chunk) {
  Manifest manifest;
  manifest.base_offset = 600;
  manifest.base_length = kHeadBytes - 600;
  manifest.file_bytes = kHeadBytes;
  for (std::uint32_t level = 0; level < levels; ++level) {
    manifest.levels.push_back(
        {.vertices = 50 * (level + 1), .faces = 100 * (level + 1), .max_error = 1.0 / (level + 1)});
    if (level == 0) continue;
    manifest.chunks.push_back(
        {.level = level, .offset = manifest.file_bytes, .length = chunk, .splits = 50});
    manifest.file_bytes += chunk;
  }
  return manifest;
}

class PromiseTest : public ::testing::Test {
 protected:
  using Rate = std::function<double(double seconds)>;  // bytes per second at a given time
  struct Said {
    double at;
    PromiseMessage promise;
  };

  void open(std::uint16_t model, const Manifest& manifest) {
    ASSERT_TRUE(state.open(model, manifest, false));
  }
  void want(std::uint16_t model, const DetailTarget& target) {
    ASSERT_TRUE(state.receive(WantMessage{model, 0, target}, time()));
  }

  // Simulates the link up to the time `until`. Slices arrive in order. Each is acknowledged at
  // once.
  void run(double until, const Rate& rate) {
    constexpr double kStep = 0.001;
    for (; now < until; now += kStep) {
      pull();
      double carried = rate(now) * kStep;
      while (!on_its_way.empty() && carried > 0) {
        const double part = std::min(carried, left);
        carried -= part;
        left -= part;
        if (left <= 0) arrive();
      }
    }
  }

  // Returns kHeadBytes plus the bytes of all chunks that have arrived completely by the time `by`.
  std::uint64_t held(std::uint16_t model, double by) const {
    std::uint64_t bytes = kHeadBytes;
    for (const auto& [at, slice] : arrived) {
      const SliceHeader& header = slice.header;
      if (at <= by && header.model == model && header.offset + slice.length == header.total)
        bytes += header.total;
    }
    return bytes;
  }
  std::uint64_t arrived_by(double time) const {
    std::uint64_t bytes = 0;
    for (const auto& [at, slice] : arrived)
      bytes += at <= time ? slice.length : 0;
    return bytes;
  }

  // Expects that the server has kept all promises made after the time `from`. Skips promises made
  // before the connection's rate was measured.
  void expect_kept(double from, double times = 1.05) const {
    std::size_t checked = 0;
    for (const auto& [at, promise] : said) {
      if (!promise.is_measured || at < from) continue;
      ++checked;
      const double by = at + times * promise.seconds + 0.02;
      EXPECT_GE(held(promise.model, by), promise.bytes)
          << "said at " << at << " of model " << promise.model << " for " << promise.seconds;
      const std::uint64_t chunks = promise.level;
      const Manifest& manifest = promise.model == 0 ? large : small;
      EXPECT_GE(held(promise.model, by), kHeadBytes + chunks * manifest.chunks[0].length);
    }
    EXPECT_GT(checked, 0u);
  }

  Pacer::Time time() const { return Pacer::Time(Pacer::Duration(1000 + now)); }

  const Manifest large = manifest_of(201, 40'000);
  const Manifest small = manifest_of(801, 10'000);
  StreamState state;
  double now = 0;
  std::vector<Said> said;
  std::vector<std::pair<double, Slice>> arrived;
  std::map<std::uint16_t, double> done;  // time of each model's "done" message

 private:
  void pull() {
    for (;;) {
      const StreamOutput output = state.next(time());
      if (std::holds_alternative<std::monostate>(output)) return;
      if (const auto* slice = std::get_if<Slice>(&output)) {
        if (on_its_way.empty()) left = slice->length;
        on_its_way.push_back(*slice);
      } else if (const auto* promise = std::get_if<PromiseMessage>(&output)) {
        said.push_back({now, *promise});
      } else {
        done[std::get<DoneMessage>(output).model] = now;
      }
    }
  }
  void arrive() {
    const Slice slice = on_its_way.front();
    on_its_way.pop_front();
    arrived.emplace_back(now, slice);
    if (!on_its_way.empty()) left = on_its_way.front().length;
    ASSERT_TRUE(state.receive(AckMessage{slice.length}, time()));
  }

  std::deque<Slice> on_its_way;
  double left = 0;  // bytes of the first slice that have not arrived yet
};

TEST_F(PromiseTest, IsKeptOverAFastAndOverASlowLink) {
  for (const double rate : {20'000.0, 100'000.0, 1'000'000.0}) {
    SCOPED_TRACE(rate);
    state = {};
    said.clear(), arrived.clear();
    open(1, small);
    const double start = now;
    want(1, WantSeconds{5});
    run(start + 6, [&](double) { return rate; });
    expect_kept(start);
    EXPECT_GE(static_cast<double>(arrived_by(start + 5)), 0.85 * 5 * rate);
  }
}

TEST_F(PromiseTest, FollowsADropOfTheRateAndIsKeptFromThenOn) {
  open(0, large);
  want(0, WantSeconds{6});
  run(7, [](double at) { return at < 1.5 ? 800'000.0 : 100'000.0; });
  EXPECT_LE(said.back().at, 2.5) << "a second after the drop";
  EXPECT_NEAR(said.back().promise.bytes_per_second, 100'000, 20'000);
  expect_kept(1.5, 1.25);
  expect_kept(said.back().at);
}

TEST_F(PromiseTest, OfTwoModelsOnOneConnectionIsKeptForBoth) {
  open(0, large);
  open(1, small);
  want(0, WantSeconds{5});
  want(1, WantSeconds{5});
  run(6, [](double) { return 200'000.0; });
  expect_kept(0);
  EXPECT_NEAR(static_cast<double>(held(0, 5)) / static_cast<double>(held(1, 5)), 1, 0.2);
  EXPECT_GE(static_cast<double>(arrived_by(5)), 0.85 * 5 * 200'000);
}

TEST_F(PromiseTest, CountsAModelThatJoinsAndOneThatIsPaused) {
  open(0, large);
  open(1, small);
  want(0, WantSeconds{6});
  run(1, [](double) { return 200'000.0; });
  want(1, Want(WantLevel{800}));
  run(3, [](double) { return 200'000.0; });
  EXPECT_NEAR(said.back().promise.bytes_per_second, 100'000, 10'000);
  ASSERT_TRUE(state.receive(PauseMessage{1, true}, time()));
  run(7, [](double) { return 200'000.0; });
  EXPECT_NEAR(said.back().promise.bytes_per_second, 200'000, 20'000);
  expect_kept(1.01);
}

// The link carries no data during the silence. Before and after the silence, the server must use
// most of the link's capacity.
TEST_F(PromiseTest, ARequestForSecondsOutlivesASilence) {
  constexpr double kRate = 200'000;
  constexpr std::pair<double, double> kSilences[] = {{1.5, 1.8}, {1.5, 2.5}, {0.5, 3}, {2, 3.2}};
  for (const auto& [from, to] : kSilences) {
    SCOPED_TRACE(testing::Message() << from << " to " << to);
    state = {};
    arrived.clear(), done.clear();
    open(0, large);
    const double start = now;
    want(0, WantSeconds{4});
    const auto rate = [&, from = start + from, to = start + to](double at) {
      return at >= from && at < to ? 0 : kRate;
    };
    run(start + 5, rate);
    EXPECT_GE(static_cast<double>(arrived_by(start + 4)), 0.85 * kRate * (4 - (to - from)));
    ASSERT_TRUE(done.contains(0));
    EXPECT_LE(done[0], start + 4.4);
  }
}

}  // namespace
}  // namespace vitrine::server
