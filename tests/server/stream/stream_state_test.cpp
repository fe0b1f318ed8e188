// SPDX-License-Identifier: Apache-2.0
#include "server/stream/stream_state.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <map>

namespace vitrine::server {
namespace {

constexpr std::uint32_t kChunk = 40'000;  // size in bytes: two whole slices and a part of a third
constexpr std::uint32_t kHead = 1'000;

// Returns a manifest whose levels have one region and 100, 200, 300 … faces.
Manifest small_manifest(std::uint32_t levels) {
  Manifest manifest;
  manifest.base_offset = 600;
  manifest.base_length = kHead - 600;
  for (std::uint32_t level = 0; level < levels; ++level) {
    manifest.levels.push_back(
        {.vertices = 50 * (level + 1), .faces = 100 * (level + 1), .max_error = 1.0 / (level + 1)});
    if (level > 0) {
      manifest.chunks.push_back({.level = level,
                                 .offset = kHead + (level - 1) * kChunk,
                                 .length = kChunk,
                                 .splits = 50,
                                 .max_error = 1.0 / (level + 1)});
    }
  }
  manifest.file_bytes = kHead + (levels - 1) * kChunk;
  return manifest;
}

class StreamStateTest : public ::testing::Test {
 protected:
  StreamStateTest() { EXPECT_TRUE(state.open(0, manifest, false)); }

  void receive(const ClientMessage& message) {
    const auto received = state.receive(message, now);
    ASSERT_TRUE(received) << received.error().message;
  }
  void want(const DetailTarget& target, std::uint16_t model = 0) {
    receive(WantMessage{model, ++turn, target});
  }

  // Returns the next output, sent over a link of `rate` bytes per second. Acknowledges each slice
  // at once.
  StreamOutput take(double rate) {
    const StreamOutput output = state.next(now);
    if (const auto* slice = std::get_if<Slice>(&output)) {
      EXPECT_GT(slice->length, 0u);
      EXPECT_LE(slice->length, kMaxSlice);
      EXPECT_EQ(slice->at, slice->header.level == 0
                               ? slice->header.offset
                               : kHead + (slice->header.level - 1) * kChunk + slice->header.offset);
      now += Pacer::Duration(slice->length / rate);
      receive(AckMessage{slice->length});
      bytes += slice->length;
    }
    return output;
  }

  // Takes all output until the server waits for another message. Returns (model, level) of each
  // chunk whose first slice was sent.
  using Chunks = std::vector<std::pair<int, int>>;
  Chunks pull(double rate = 1e6) {
    Chunks started;
    bytes = 0;
    done.reset();
    promises.clear();
    for (;;) {
      const auto output = take(rate);
      if (const auto* slice = std::get_if<Slice>(&output)) {
        if (slice->header.offset == 0)
          started.emplace_back(slice->header.model, slice->header.level);
      } else if (const auto* message = std::get_if<DoneMessage>(&output)) {
        EXPECT_FALSE(done) << "done is said once";
        done = *message;
      } else if (const auto* promise = std::get_if<PromiseMessage>(&output)) {
        promises.push_back(*promise);
      } else {
        return started;
      }
    }
  }

  const Manifest manifest = small_manifest(4);
  const Manifest tall = small_manifest(101);
  StreamState state;
  Pacer::Time now{Pacer::Duration(1000)};
  std::uint32_t turn = 0;
  std::uint64_t bytes = 0;
  std::optional<DoneMessage> done;
  std::vector<PromiseMessage> promises;
};

TEST_F(StreamStateTest, SendsNothingBeforeARequest) {
  EXPECT_EQ(pull(), Chunks{});
  EXPECT_FALSE(done);
}

TEST_F(StreamStateTest, SendsTheChunksOfARequestInOrderAndThenSaysDone) {
  want(Want(WantLevel{2}));
  EXPECT_EQ(pull(), (Chunks{{0, 1}, {0, 2}}));
  EXPECT_EQ(bytes, 2 * kChunk);
  EXPECT_EQ(done, (DoneMessage{.turn = 1, .bytes = kHead + 2 * kChunk, .triangles = 300}));
}

TEST_F(StreamStateTest, SendsTheHeadFirstWhereItIsAskedFor) {
  ASSERT_TRUE(state.open(1, manifest, true));
  EXPECT_EQ(pull(), (Chunks{{1, 0}}));
  EXPECT_EQ(bytes, kHead);
  EXPECT_FALSE(done) << "a head is no target";
}

TEST_F(StreamStateTest, SlicesOfAChunkFollowEachOtherWithoutGaps) {
  want(Want(WantLevel{1}));
  std::uint32_t offset = 0;
  while (offset < kChunk) {
    const auto slice = std::get<Slice>(take(1e6));
    EXPECT_EQ(slice.header.offset, offset);
    EXPECT_EQ(slice.header.total, kChunk);
    offset += slice.length;
  }
  EXPECT_TRUE(std::holds_alternative<DoneMessage>(state.next(now)));
}

TEST_F(StreamStateTest, SendsNoByteBeyondTheCredit) {
  want(Want(WantLevel{3}));
  std::uint64_t sent = 0;
  for (int i = 0; i < 1000; ++i, now += Pacer::kNudge) {
    const auto output = state.next(now);
    if (const auto* slice = std::get_if<Slice>(&output)) sent += slice->length;
  }
  EXPECT_EQ(sent, kFirstCredit);
  EXPECT_EQ(state.credit(), 0u);
  receive(AckMessage{100});
  now += Pacer::kNudge;
  EXPECT_EQ(std::get<Slice>(state.next(now)).length, 100u);
  EXPECT_TRUE(std::holds_alternative<std::monostate>(state.next(now)));
}

TEST_F(StreamStateTest, KeepsLittleOnItsWayThatIsNotAcknowledged) {
  want(Want(WantLevel{3}));
  std::uint64_t sent = 0;
  for (;;) {
    const auto output = state.next(now);
    if (!std::holds_alternative<Slice>(output)) break;
    sent += std::get<Slice>(output).length;
  }
  EXPECT_LE(sent, 18'000u);
  EXPECT_EQ(state.wakes(now), now + Pacer::kNudge) << "a client may acknowledge many at a time";
}

TEST_F(StreamStateTest, AClientThatGrantsAheadIsPacedByTheKernel) {
  receive(AckMessage{1'000'000});
  EXPECT_TRUE(state.is_granted_ahead());
  want(Want(WantLevel{3}));
  std::uint64_t sent = 0;
  while (std::holds_alternative<Slice>(state.next(now)))
    ++sent;
  EXPECT_GT(sent, 0u);
  EXPECT_FALSE(done);
  ASSERT_TRUE(state.wakes(now));
  state.still_queued(0, now);
  EXPECT_TRUE(std::holds_alternative<Slice>(state.next(now)));
}

TEST_F(StreamStateTest, DoesNotSendWhatTheClientHolds) {
  receive(HaveMessage{0, {{0, 1}}});
  want(Want(WantLevel{3}));
  EXPECT_EQ(pull(), (Chunks{{0, 3}}));
  EXPECT_EQ(done->triangles, 400u);
}

TEST_F(StreamStateTest, ANewRequestInterruptsTheChunkUnderWay) {
  want(Want(WantLevel{3}));
  const auto first = std::get<Slice>(take(1e6));
  want(Want(WantLevel{0}));
  EXPECT_EQ(pull(), Chunks{});
  EXPECT_EQ(done, (DoneMessage{.turn = 2, .bytes = kHead, .triangles = 100}));
  want(Want(WantLevel{1}));
  const auto rest = std::get<Slice>(take(1e6));
  EXPECT_EQ(rest.header.level, 1);
  EXPECT_EQ(rest.header.offset, first.length) << "it continues where it stopped";
}

// The bounding box of the test's model is a single point, the origin.
TEST_F(StreamStateTest, ACameraIsSentWhatItSees) {
  View view{.camera = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 100, 1},
            .field_of_view = 30,
            .width = 800,
            .height = 600};
  view.camera[10] = -1;  // the camera looks away from the model
  want(Want(view));
  EXPECT_EQ(pull(), Chunks{});
  EXPECT_TRUE(done);
  view.camera[10] = 1;
  want(Want(view));
  EXPECT_EQ(pull(), (Chunks{{0, 1}, {0, 2}, {0, 3}}));
  EXPECT_TRUE(done);
}

TEST_F(StreamStateTest, EachRequestIsAnsweredByDone) {
  want(Want(WantError{0.5}));
  EXPECT_EQ(pull(), (Chunks{{0, 1}}));
  EXPECT_EQ(done->turn, 1u);
  EXPECT_EQ(pull(), Chunks{});
  EXPECT_FALSE(done) << "once";
  want(Want(WantError{0.5}));
  pull();
  EXPECT_EQ(done->turn, 2u) << "again, as it was asked again";
}

TEST_F(StreamStateTest, ARequestForBytesCountsTheHead) {
  want(Want(WantBytes{kHead + kChunk}));
  EXPECT_EQ(pull(), (Chunks{{0, 1}}));
  want(Want(WantBytes{kHead + 2 * kChunk - 1}));
  EXPECT_EQ(pull(), Chunks{});
}

TEST_F(StreamStateTest, APausedModelSendsNothingUntilItGoesOn) {
  want(Want(WantLevel{1}));
  take(1e6);
  receive(PauseMessage{0, true});
  EXPECT_EQ(pull(), Chunks{});
  EXPECT_EQ(bytes, 0u);
  receive(PauseMessage{0, false});
  pull();
  EXPECT_GT(bytes, 0u);
  EXPECT_TRUE(done);
}

TEST_F(StreamStateTest, AHeadWaitsWhileItsModelIsPaused) {
  ASSERT_TRUE(state.open(1, manifest, true));
  receive(PauseMessage{1, true});
  EXPECT_EQ(pull(), Chunks{});
  receive(PauseMessage{1, false});
  EXPECT_EQ(pull(), (Chunks{{1, 0}}));
}

TEST_F(StreamStateTest, ModelsShareTheConnectionSliceBySlice) {
  ASSERT_TRUE(state.open(7, manifest, false));
  want(Want(WantLevel{2}), 0);
  want(Want(WantLevel{2}), 7);
  Chunks started;
  std::map<int, std::int64_t> sent;
  for (int dones = 0; dones < 2;) {
    const auto output = take(1e6);
    if (const auto* slice = std::get_if<Slice>(&output)) {
      if (slice->header.offset == 0) started.emplace_back(slice->header.model, slice->header.level);
      sent[slice->header.model] += slice->length;
      EXPECT_LE(std::abs(sent[0] - sent[7]), std::int64_t{kMaxSlice});
    }
    if (std::holds_alternative<DoneMessage>(output)) ++dones;
  }
  EXPECT_EQ(started.size(), 4u);
}

TEST_F(StreamStateTest, AModelThatWasIdleHasSavedUpNothing) {
  ASSERT_TRUE(state.open(7, manifest, false));
  want(Want(WantLevel{2}), 0);
  pull();
  want(Want(WantLevel{3}), 0);
  want(Want(WantLevel{3}), 7);
  std::map<int, std::int64_t> sent;
  while (sent[0] < kChunk) {
    const auto output = take(1e6);
    if (const auto* slice = std::get_if<Slice>(&output)) sent[slice->header.model] += slice->length;
  }
  EXPECT_LE(sent[7], kChunk + kMaxSlice);
}

TEST_F(StreamStateTest, ANumberStandsForOneModelUntilItIsClosed) {
  EXPECT_FALSE(state.open(0, manifest, false));
  receive(CloseMessage{0});
  EXPECT_FALSE(state.receive(WantMessage{0, 0, Want(WantLevel{1})}, now));
  EXPECT_TRUE(state.open(0, manifest, false));
}

TEST_F(StreamStateTest, RefusesChunksThatTheModelDoesNotHave) {
  EXPECT_FALSE(state.receive(HaveMessage{0, {{0, 3}}}, now));
  EXPECT_FALSE(state.receive(HaveMessage{0, {{UINT64_MAX, UINT64_MAX}}}, now));
}

TEST_F(StreamStateTest, CreditIsBounded) {
  for (int i = 0; i < 100; ++i)
    receive(AckMessage{kMaxAck});
  EXPECT_EQ(state.credit(), kMaxCredit);
}

class SecondsTest : public StreamStateTest {
 protected:
  SecondsTest() { EXPECT_TRUE(state.open(1, tall, false)); }
};

TEST_F(SecondsTest, TheFirstPromiseIsAGuessThatSaysSo) {
  want(WantSeconds{2}, 1);
  const auto promise = std::get<PromiseMessage>(state.next(now));
  EXPECT_FALSE(promise.is_measured);
  EXPECT_EQ(promise.bytes_per_second, Pacer::kFirstGuess);
  EXPECT_EQ(promise.turn, 1u);
  EXPECT_EQ(promise.bytes, kHead + 1 * kChunk) << "64 kB: one chunk of 40 kB is in time";
  EXPECT_EQ(promise.level, 1u);
  EXPECT_EQ(promise.triangles, 200u);
  EXPECT_EQ(promise.error, 0.5);
  EXPECT_NEAR(promise.seconds, kChunk / Pacer::kFirstGuess, 1e-9);
}

TEST_F(SecondsTest, APromiseComesBeforeTheHead) {
  ASSERT_TRUE(state.open(2, tall, true));
  want(WantSeconds{2}, 2);
  const auto promise = std::get<PromiseMessage>(state.next(now));
  EXPECT_NEAR(promise.seconds, (kHead + kChunk) / Pacer::kFirstGuess, 1e-9);
  EXPECT_EQ(std::get<Slice>(state.next(now)).header.level, 0) << "the head";
}

TEST_F(SecondsTest, WhatIsNotKnownToBeSlowIsTried) {
  want(WantSeconds{0.5}, 1);
  pull(1e7);
  ASSERT_TRUE(done);
  EXPECT_EQ(promises.front().bytes, kHead) << "16 kB at the first guess: no chunk is promised";
  EXPECT_EQ(done->bytes, tall.file_bytes);
}

TEST_F(SecondsTest, AsMuchComesAsTheConnectionBrings) {
  const auto start = now;
  want(WantSeconds{2}, 1);
  pull(400'000);
  ASSERT_TRUE(done);
  EXPECT_NEAR((now - start).count(), 2, 0.1);
  EXPECT_GE(static_cast<double>(bytes), 0.9 * 800'000);
  ASSERT_GE(promises.size(), 2u);
  EXPECT_TRUE(promises.back().is_measured);
  EXPECT_NEAR(static_cast<double>(promises.back().bytes) / static_cast<double>(done->bytes), 1,
              0.1);
}

TEST_F(SecondsTest, AModelThatIsWholeEarlierIsDoneThen) {
  want(WantSeconds{60});
  pull(400'000);
  EXPECT_EQ(done, (DoneMessage{.turn = 1, .bytes = manifest.file_bytes, .triangles = 400}));
}

TEST_F(SecondsTest, TimePassesWhileNothingArrives) {
  want(WantSeconds{2}, 1);
  while (std::holds_alternative<Slice>(state.next(now)) ||
         std::holds_alternative<PromiseMessage>(state.next(now))) {
  }
  EXPECT_TRUE(state.wakes(now));
}

}  // namespace
}  // namespace vitrine::server
