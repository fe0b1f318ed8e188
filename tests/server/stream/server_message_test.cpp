// SPDX-License-Identifier: Apache-2.0
#include "server/stream/server_message.h"

#include <gtest/gtest.h>

namespace vitrine::server {
namespace {

TEST(ServerMessage, IsWrittenAsTheProtocolSays) {
  EXPECT_EQ(to_json(DoneMessage{.model = 1, .turn = 2, .bytes = 5, .triangles = 7}),
            R"({"type":"done","model":1,"turn":2,"bytes":5,"triangles":7})");
  EXPECT_EQ(to_json(ClosedMessage{.model = 1, .reason = "as asked"}),
            R"({"type":"closed","model":1,"reason":"as asked"})");
  EXPECT_EQ(to_json(ModelMessage{.model = 0,
                                 .sha256 = "ab",
                                 .chunks = 3,
                                 .head_bytes = 9,
                                 .slice_bytes = 16384,
                                 .credit = 65536}),
            R"({"type":"model","model":0,"sha256":"ab","chunks":3,"head_bytes":9,)"
            R"("slice_bytes":16384,"credit":65536})");
  EXPECT_EQ(to_json(PromiseMessage{.model = 0,
                                   .turn = 4,
                                   .level = 6,
                                   .bytes = 10,
                                   .triangles = 20,
                                   .error = 0.5,
                                   .seconds = 1.5,
                                   .bytes_per_second = 100.5,
                                   .is_measured = true}),
            R"({"type":"promise","model":0,"turn":4,"level":6,"bytes":10,"triangles":20,)"
            R"("error":0.5,"seconds":1.5,"bytes_per_second":100.5,"measured":true})");
}

TEST(ServerMessage, WhatIsWrittenIsRead) {
  const ServerMessage messages[] = {
      ModelMessage{.model = 3, .sha256 = "ab", .chunks = 3, .slice_bytes = 5, .credit = 7},
      ModelMessage{.model = 4, .sha256 = "ab", .presentation = R"({"scale":2})"},
      PromiseMessage{.model = 1, .level = 6, .error = 0.5, .seconds = 1.5, .is_measured = true},
      DoneMessage{.model = 1, .turn = 2, .bytes = 5, .triangles = 7},
      ClosedMessage{.model = 1, .reason = "as asked"},
  };
  for (const ServerMessage& message : messages) {
    const auto read = parse_server_message(to_json(message));
    ASSERT_TRUE(read) << to_json(message);
    EXPECT_EQ(*read, message);
  }
}

TEST(ServerMessage, EverythingElseIsRefused) {
  const std::string deep = std::string(60'000, '[');
  const std::string_view bad[] = {
      "",
      deep,
      "[]",
      "{}",
      R"({"type":1})",
      R"({"type":"want"})",
      R"({"type":"done","model":1,"turn":0,"bytes":5})",
      R"({"type":"done","model":65536,"turn":0,"bytes":5,"triangles":7})",
      R"({"type":"done","model":1,"turn":0,"bytes":-5,"triangles":7})",
      R"({"type":"closed","model":1,"reason":["x"]})",
  };
  for (const std::string_view text : bad)
    EXPECT_FALSE(parse_server_message(text)) << text.substr(0, 80);
}

}  // namespace
}  // namespace vitrine::server
