// SPDX-License-Identifier: Apache-2.0
#include "server/stream/stream_state.h"

#include <gtest/gtest.h>

namespace vitrine {
namespace {

constexpr std::uint32_t kChunk = 40'000;  // two whole slices and a part
constexpr std::uint32_t kHead = 1'000;

// Four levels of one region: 100, 200, 300 and 400 faces.
Manifest small_manifest() {
  Manifest manifest;
  manifest.base_offset = 600;
  manifest.base_length = kHead - 600;
  for (std::uint32_t level = 0; level < 4; ++level) {
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
  manifest.file_bytes = kHead + 3 * kChunk;
  return manifest;
}

class StreamStateTest : public ::testing::Test {
 protected:
  void receive(const ClientMessage& message) {
    const auto received = state.receive(message);
    ASSERT_TRUE(received) << received.error().message;
  }

  // Everything that is sent without further messages; the indices of the chunks that were started.
  std::vector<std::size_t> pull() {
    std::vector<std::size_t> started;
    bytes = 0;
    done.reset();
    for (;;) {
      const auto output = state.next();
      if (const auto* slice = std::get_if<Slice>(&output)) {
        EXPECT_GT(slice->length, 0u);
        EXPECT_LE(slice->length, kMaxSlice);
        if (slice->offset == 0) started.push_back(slice->chunk);
        bytes += slice->length;
      } else if (const auto* message = std::get_if<DoneMessage>(&output)) {
        EXPECT_FALSE(done) << "done is said once";
        done = *message;
      } else {
        return started;
      }
    }
  }

  const Manifest manifest = small_manifest();
  StreamState state{manifest};
  std::uint64_t bytes = 0;
  std::optional<DoneMessage> done;
};

using Chunks = std::vector<std::size_t>;

TEST_F(StreamStateTest, SendsNothingBeforeAWish) {
  EXPECT_EQ(pull(), Chunks{});
  EXPECT_FALSE(done);
}

TEST_F(StreamStateTest, SendsTheChunksOfAWishInOrderAndThenSaysDone) {
  receive(AckMessage{1'000'000});
  receive(Want(WantLevel{2}));
  EXPECT_EQ(pull(), (Chunks{0, 1}));
  EXPECT_EQ(bytes, 2 * kChunk);
  EXPECT_EQ(done, (DoneMessage{.bytes = kHead + 2 * kChunk, .triangles = 300}));
}

TEST_F(StreamStateTest, SlicesOfAChunkFollowEachOtherWithoutGaps) {
  receive(Want(WantLevel{1}));
  const Slice expected[] = {
      {0, 0, kMaxSlice}, {0, kMaxSlice, kMaxSlice}, {0, 2 * kMaxSlice, kChunk - 2 * kMaxSlice}};
  for (const Slice& slice : expected)
    EXPECT_EQ(std::get<Slice>(state.next()), slice);
}

TEST_F(StreamStateTest, SendsNoByteBeyondTheCredit) {
  receive(Want(WantLevel{3}));
  pull();
  EXPECT_EQ(bytes, kFirstCredit);
  EXPECT_EQ(state.credit(), 0u);
  EXPECT_FALSE(done);
  receive(AckMessage{100});
  pull();
  EXPECT_EQ(bytes, 100u);
  receive(AckMessage{1'000'000});
  pull();
  EXPECT_EQ(bytes, 3 * kChunk - kFirstCredit - 100);
  EXPECT_TRUE(done);
}

TEST_F(StreamStateTest, DoesNotSendWhatTheClientHolds) {
  receive(HaveMessage{{{0, 1}}});
  receive(Want(WantLevel{3}));
  EXPECT_EQ(pull(), Chunks{2});
  EXPECT_EQ(done->triangles, 400u);
}

TEST_F(StreamStateTest, ANewWishTakesEffectAtTheNextChunk) {
  receive(Want(WantLevel{3}));
  EXPECT_TRUE(std::holds_alternative<Slice>(state.next()));
  receive(Want(WantLevel{0}));
  receive(AckMessage{1'000'000});
  EXPECT_EQ(pull(), Chunks{}) << "only the chunk under way is finished";
  EXPECT_EQ(bytes, kChunk - kMaxSlice);
  EXPECT_EQ(done, (DoneMessage{.bytes = kHead + kChunk, .triangles = 200}));
}

// The box of the test's model is the origin.
TEST_F(StreamStateTest, ACameraIsSentWhatItSees) {
  View view{.camera = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 100, 1},
            .field_of_view = 30,
            .width = 800,
            .height = 600};
  receive(AckMessage{1'000'000});
  view.camera[10] = -1;  // looks away
  receive(Want(view));
  EXPECT_EQ(pull(), Chunks{});
  EXPECT_TRUE(done);
  view.camera[10] = 1;
  receive(Want(view));
  EXPECT_EQ(pull(), (Chunks{0, 1, 2}));
  EXPECT_TRUE(done);
}

TEST_F(StreamStateTest, EachWishIsAnsweredByDone) {
  receive(Want(WantError{0.5}));
  EXPECT_EQ(pull(), Chunks{0});
  EXPECT_TRUE(done);
  EXPECT_EQ(pull(), Chunks{});
  EXPECT_FALSE(done) << "once";
  receive(Want(WantError{0.5}));
  pull();
  EXPECT_TRUE(done) << "again, as it was asked again";
}

TEST_F(StreamStateTest, AWishForBytesCountsTheHead) {
  receive(Want(WantBytes{kHead + kChunk}));
  EXPECT_EQ(pull(), Chunks{0});
  receive(Want(WantBytes{kHead + 2 * kChunk - 1}));
  EXPECT_EQ(pull(), Chunks{});
}

TEST_F(StreamStateTest, RefusesChunksThatTheModelDoesNotHave) {
  EXPECT_FALSE(state.receive(HaveMessage{{{0, 3}}}));
  EXPECT_FALSE(state.receive(HaveMessage{{{UINT64_MAX, UINT64_MAX}}}));
}

TEST_F(StreamStateTest, CreditIsBounded) {
  for (int i = 0; i < 100; ++i)
    receive(AckMessage{kMaxAck});
  EXPECT_EQ(state.credit(), kMaxCredit);
}

}  // namespace
}  // namespace vitrine
