// SPDX-License-Identifier: Apache-2.0
#include "server/stream/message.h"

#include <gtest/gtest.h>

namespace vitrine::server {
namespace {

template <class Wanted>
std::optional<Wanted> want_of(std::string_view text) {
  const auto message = parse_message(text);
  if (!message || !std::holds_alternative<WantMessage>(*message)) return std::nullopt;
  const DetailTarget& target = std::get<WantMessage>(*message).target;
  if (!std::holds_alternative<Want>(target)) return std::nullopt;
  const Want& want = std::get<Want>(target);
  return std::holds_alternative<Wanted>(want) ? std::optional(std::get<Wanted>(want))
                                              : std::nullopt;
}

TEST(Message, ReadsEachKindOfWant) {
  EXPECT_EQ(want_of<WantTriangles>(R"({"type":"want","triangles":500})")->triangles, 500u);
  EXPECT_EQ(want_of<WantBytes>(R"({"type":"want","bytes":0})")->bytes, 0u);
  EXPECT_EQ(want_of<WantError>(R"({"type":"want","error":0.25})")->error, 0.25);
  EXPECT_EQ(want_of<WantError>(R"({"type":"want","error":1})")->error, 1.0);
  EXPECT_EQ(want_of<WantLevel>(R"({"level":3,"type":"want","later":"member"})")->level, 3u);
  EXPECT_EQ(want_of<WantLevel>(R"({"level":99999999999,"type":"want"})")->level, UINT32_MAX);
}

TEST(Message, ReadsARequestForTimeWithItsModelAndTurn) {
  const auto message =
      parse_message(R"({"type":"want","model":15,"turn":4294967295,"seconds":0.5})");
  ASSERT_TRUE(message) << message.error().message;
  const auto& want = std::get<WantMessage>(*message);
  EXPECT_EQ(want.model, 15);
  EXPECT_EQ(want.turn, UINT32_MAX);
  EXPECT_EQ(std::get<WantSeconds>(want.target).seconds, 0.5);
}

TEST(Message, ReadsACamera) {
  const auto view = want_of<View>(
      R"({"type":"want","view":{"camera":[1,0,0,0,0,1,0,0,0,0,1,0,5,6,7.5,1],"fov":35,)"
      R"("width":800,"height":600,"pixels":1.5,"bytes":90000}})");
  ASSERT_TRUE(view);
  EXPECT_EQ(view->camera[14], 7.5);
  EXPECT_EQ(view->field_of_view, 35);
  EXPECT_EQ(view->width, 800);
  EXPECT_EQ(view->height, 600);
  EXPECT_EQ(view->pixel_error, 1.5);
  EXPECT_EQ(view->bytes, 90'000);
}

TEST(Message, ReadsHaveAndAck) {
  const auto have = parse_message(R"({"type":"have","chunks":[[0,4],[7,7]]})");
  ASSERT_TRUE(have) << have.error().message;
  EXPECT_EQ(std::get<HaveMessage>(*have).chunks.size(), 2u);
  EXPECT_EQ(std::get<HaveMessage>(*have).chunks[0].last, 4u);
  const auto ack = parse_message(R"({"type":"ack","bytes":16384})");
  ASSERT_TRUE(ack) << ack.error().message;
  EXPECT_EQ(std::get<AckMessage>(*ack).bytes, 16384u);
}

TEST(Message, ReadsWhatIsSaidOfModels) {
  const auto open = parse_message(R"({"type":"open","model":3,"id":"abc","head":true})");
  ASSERT_TRUE(open) << open.error().message;
  EXPECT_EQ(std::get<OpenMessage>(*open).model, 3);
  EXPECT_EQ(std::get<OpenMessage>(*open).id, "abc");
  EXPECT_TRUE(std::get<OpenMessage>(*open).wants_head);
  EXPECT_EQ(std::get<CloseMessage>(*parse_message(R"({"type":"close","model":3})")).model, 3);
  EXPECT_TRUE(std::get<PauseMessage>(*parse_message(R"({"type":"pause"})")).is_pause);
  EXPECT_FALSE(std::get<PauseMessage>(*parse_message(R"({"type":"resume"})")).is_pause);
}

TEST(Message, WhatIsWrittenIsRead) {
  const View view{.camera = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7.5, 1},
                  .field_of_view = 35,
                  .width = 800,
                  .height = 600,
                  .bytes = 5000};
  const ClientMessage messages[] = {
      OpenMessage{.model = 2, .id = "abc", .wants_head = true},
      CloseMessage{2},
      WantMessage{1, 7, Want(WantTriangles{500})},
      WantMessage{1, 7, Want(WantBytes{500})},
      WantMessage{1, 7, Want(WantError{0.125})},
      WantMessage{1, 7, Want(WantLevel{5})},
      WantMessage{1, 7, Want(view)},
      WantMessage{1, 7, WantSeconds{2.5}},
      HaveMessage{1, {{0, 4}, {7, 7}}},
      PauseMessage{1, true},
      PauseMessage{1, false},
      AckMessage{77},
  };
  for (const ClientMessage& message : messages) {
    const std::string text = to_json(message);
    const auto read = parse_message(text);
    ASSERT_TRUE(read) << text << ": " << read.error().message;
    EXPECT_EQ(to_json(*read), text);
  }
}

TEST(Message, RefusesEverythingElseWithAReasonThatFitsACloseFrame) {
  const std::string deep = std::string(60'000, '[');
  const std::string too_many = [] {
    std::string text = R"({"type":"have","chunks":[)";
    for (std::size_t i = 0; i <= kMaxHaveRanges; ++i) {
      text += (i == 0 ? "[" : ",[") + std::to_string(i) + "," + std::to_string(i) + "]";
    }
    return text + "]}";
  }();
  const std::string_view bad[] = {
      "",
      "want",
      "[]",
      "null",
      "{}",
      deep,
      too_many,
      R"({"type":1})",
      R"({"type":"view"})",
      R"({"type":"want"})",
      R"({"type":"want","triangles":1,"bytes":1})",
      R"({"type":"want","triangles":-1})",
      R"({"type":"want","triangles":1.5})",
      R"({"type":"want","triangles":"1"})",
      R"({"type":"want","level":1e3})",
      R"({"type":"want","error":-1})",
      R"({"type":"want","view":1})",
      R"({"type":"want","view":{"camera":[1],"fov":35,"width":8,"height":6,"pixels":1}})",
      R"({"type":"want","view":{"camera":[0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0],"fov":35,"width":8,"height":6}})",
      R"({"type":"want","view":{"camera":[0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0],"fov":180,"width":8,"height":6,"pixels":1}})",
      R"({"type":"want","view":{"camera":[0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,"0"],"fov":35,"width":8,"height":6,"pixels":1}})",
      R"({"type":"want","level":1,"view":{"camera":[0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0],"fov":35,"width":8,"height":6,"pixels":1}})",
      R"({"type":"want","error":"0"})",
      R"({"type":"want","error":null})",
      R"({"type":"want","seconds":0})",
      R"({"type":"want","seconds":3601})",
      R"({"type":"want","seconds":"1"})",
      R"({"type":"want","seconds":1,"level":1})",
      R"({"type":"want","level":1,"turn":-1})",
      R"({"type":"want","level":1,"turn":4294967296})",
      R"({"type":"want","level":1,"model":16})",
      R"({"type":"want","level":1,"model":"0"})",
      R"({"type":"pause","model":-1})",
      R"({"type":"open","model":1})",
      R"({"type":"open","model":1,"id":5})",
      R"({"type":"open","model":1,"id":"a","head":1})",
      R"({"type":"open","model":1,"id":"01234567890123456789012345678901234567890123456789012345678901234"})",
      R"({"type":"ack"})",
      R"({"type":"ack","bytes":0})",
      R"({"type":"ack","bytes":16777217})",
      R"({"type":"ack","bytes":18446744073709551616})",
      R"({"type":"have"})",
      R"({"type":"have","chunks":{}})",
      R"({"type":"have","chunks":[1]})",
      R"({"type":"have","chunks":[[1]]})",
      R"({"type":"have","chunks":[[2,1]]})",
      R"({"type":"have","chunks":[[0,5],[5,6]]})",
      R"({"type":"have","chunks":[[[0],5]]})",
      "{\"type\":\"want\",\"level\":1}\xff",
  };
  for (const std::string_view text : bad) {
    const auto message = parse_message(text);
    ASSERT_FALSE(message) << text.substr(0, 80);
    EXPECT_LE(message.error().message.size(), 123u);
  }
}

TEST(Message, ALongHaveIsSaidInSeveral) {
  std::vector<ChunkRange> ranges;
  for (std::uint64_t i = 0; i < 10'000; ++i)
    ranges.push_back({UINT32_MAX - 100'000 + 2 * i, UINT32_MAX - 100'000 + 2 * i});
  std::vector<std::uint64_t> told;
  for (const HaveMessage& message : have_messages(3, ranges)) {
    const std::string text = to_json(message);
    EXPECT_LE(text.size(), kMaxMessage);
    const auto parsed = parse_message(text);
    ASSERT_TRUE(parsed) << parsed.error().message;
    EXPECT_EQ(std::get<HaveMessage>(*parsed).model, 3);
    for (const ChunkRange& range : std::get<HaveMessage>(*parsed).chunks)
      told.push_back(range.first);
  }
  ASSERT_EQ(told.size(), ranges.size());
  EXPECT_EQ(told.front(), ranges.front().first);
  EXPECT_EQ(told.back(), ranges.back().last);
  EXPECT_TRUE(have_messages(0, {}).empty());
}

}  // namespace
}  // namespace vitrine::server
