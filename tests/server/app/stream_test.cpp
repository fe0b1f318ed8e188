// SPDX-License-Identifier: Apache-2.0
// pmesh.v1 of the real daemon.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>

#include "served_folder.h"
#include "support/daemon.h"
#include "support/http_client.h"

namespace vitrine::test {
namespace {

using Json = nlohmann::json;

class StreamTest : public ::testing::Test {
 protected:
  std::string url() const { return "/api/v1/models/" + id + "/stream"; }
  WebSocketClient connect() const { return {daemon.port(), url(), "pmesh.v1"}; }

  const ChunkInfo& chunk = served_pmesh().manifest.chunks[0];
  ServedFolder folder;
  const std::string id = folder.publish("A small bust");
  Daemon daemon{folder.path()};
};

TEST_F(StreamTest, SendsTheWantedChunkInSlicesAndThenDone) {
  WebSocketClient client = connect();
  const Json model = Json::parse(client.receive().payload);
  EXPECT_EQ(model["type"], "model");
  EXPECT_EQ(model["chunks"], 1);
  EXPECT_EQ(model["sha256"], to_hex(sha256(served_pmesh().bytes)));
  client.send_text(R"({"type":"want","level":1})");
  std::string bytes;
  while (bytes.size() < chunk.length) {
    const WebSocketFrame frame = client.receive();
    ASSERT_EQ(frame.kind, WebSocketFrame::kBinary);
    ASSERT_LE(frame.payload.size(), 12u + 16384u);
    EXPECT_EQ(static_cast<unsigned char>(frame.payload[0]), 1u) << "the level";
    bytes += frame.payload.substr(12);
  }
  EXPECT_EQ(bytes, file_bytes(chunk.offset, chunk.length));
  const Json done = Json::parse(client.receive().payload);
  EXPECT_EQ(done["type"], "done");
  EXPECT_EQ(done["bytes"], served_pmesh().manifest.file_bytes);
  EXPECT_EQ(done["triangles"], 8);
}

TEST_F(StreamTest, SkipsWhatTheClientHolds) {
  WebSocketClient client = connect();
  client.receive();
  client.send_text(R"({"type":"have","chunks":[[0,0]]})");
  client.send_text(R"({"type":"want","level":1})");
  EXPECT_EQ(Json::parse(client.receive().payload)["type"], "done");
}

TEST_F(StreamTest, ClosesWithAReasonAtAMessageThatBreaksTheRules) {
  WebSocketClient client = connect();
  client.receive();
  client.send_text(R"({"type":"want","level":-1})");
  const WebSocketFrame frame = client.receive();
  ASSERT_EQ(frame.kind, WebSocketFrame::kClose);
  EXPECT_EQ(frame.close_code(), 1008);
  EXPECT_THAT(frame.payload, ::testing::HasSubstr("whole numbers"));
}

TEST_F(StreamTest, ClosesAtABinaryMessage) {
  WebSocketClient client = connect();
  client.receive();
  client.send_binary(R"({"type":"want","level":1})");
  EXPECT_EQ(client.receive().close_code(), 1008);
}

TEST_F(StreamTest, ClosesAtAMessageThatIsTooLong) {
  WebSocketClient client = connect();
  client.receive();
  client.send_text(std::string(65 * 1024, ' '));
  EXPECT_EQ(client.receive().close_code(), 1009);
}

TEST_F(StreamTest, NeedsTheUpgradeAndTheSubprotocol) {
  const HttpAnswer plain = http_get(daemon.port(), url());
  EXPECT_EQ(plain.status, 426);
  EXPECT_EQ(plain.field("upgrade"), "websocket");
  EXPECT_THROW(WebSocketClient(daemon.port(), url(), "other.v1"), std::runtime_error);
  EXPECT_THROW(WebSocketClient(daemon.port(), "/api/v1/models/00000000000000000000000001/stream",
                               "pmesh.v1"),
               std::runtime_error);
}

TEST_F(StreamTest, AShutdownTellsClientsToComeBack) {
  {
    WebSocketClient client = connect();
    client.receive();
    daemon.signal(SIGTERM);
    const WebSocketFrame frame = client.receive();
    ASSERT_EQ(frame.kind, WebSocketFrame::kClose);
    EXPECT_EQ(frame.close_code(), 1012);
    client.send_close();
  }
  EXPECT_EQ(daemon.wait().exit_code, 0);
}

}  // namespace
}  // namespace vitrine::test
