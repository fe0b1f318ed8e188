// SPDX-License-Identifier: Apache-2.0
#include "server/stream/message.h"

#include <gtest/gtest.h>

namespace vitrine {
namespace {

template <class Wanted>
std::optional<Wanted> want_of(std::string_view text) {
  const auto message = parse_message(text);
  if (!message || !std::holds_alternative<Want>(*message)) return std::nullopt;
  const Want& want = std::get<Want>(*message);
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

TEST(Message, WritesWhatTheProtocolSays) {
  EXPECT_EQ(to_json(DoneMessage{.bytes = 5, .triangles = 7}),
            R"({"type":"done","bytes":5,"triangles":7})");
  EXPECT_EQ(
      to_json(ModelMessage{.sha256 = "ab", .chunks = 3, .slice_bytes = 16384, .credit = 65536}),
      R"({"type":"model","sha256":"ab","chunks":3,"slice_bytes":16384,"credit":65536})");
}

}  // namespace
}  // namespace vitrine
