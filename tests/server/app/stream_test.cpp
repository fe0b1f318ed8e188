// SPDX-License-Identifier: Apache-2.0
// Tests streams of the real daemon (subprotocol pmesh.v1).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>

#include "support/process/daemon.h"
#include "support/process/http_client.h"
#include "support/product_names.h"
#include "support/served_folder.h"

namespace vitrine::test {
namespace {

using Json = nlohmann::json;

void end(Daemon& daemon) {
  daemon.signal(SIGTERM);
  EXPECT_EQ(daemon.wait().exit_code, 0);
}

class StreamTest : public ::testing::Test {
 protected:
  std::string url() const { return "/api/v1/models/" + id + "/stream"; }
  WebSocketClient connect(const std::string& query = "", const std::string& fields = "") const {
    return {daemon.port(), url() + query, "pmesh.v1", fields};
  }
  std::string bearer(Role role) { return bearer(folder.token(role)); }
  static std::string bearer(const std::string& token) {
    return "Authorization: Bearer " + token + "\r\n";
  }
  void hide() const {
    const std::string target = "/api/v1/models/" + id + "/unpublish";
    EXPECT_EQ(http_get(daemon.port(), target, operator_, "POST").status, 200);
  }
  // Receives a text frame and returns its JSON.
  static Json told(WebSocketClient& client) {
    WebSocketFrame frame = client.receive();
    EXPECT_EQ(frame.kind, WebSocketFrame::kText);
    return Json::parse(frame.payload);
  }
  // Receives the slices of one chunk into `bytes` and acknowledges each. Returns the first slice's
  // header.
  static std::string take(WebSocketClient& client, std::size_t length, std::string& bytes) {
    std::string header;
    while (bytes.size() < length) {
      const WebSocketFrame frame = client.receive();
      EXPECT_EQ(frame.kind, WebSocketFrame::kBinary) << frame.payload;
      EXPECT_LE(frame.payload.size(), 16u + 16384u);
      if (bytes.empty()) header = frame.payload.substr(0, 16);
      bytes += frame.payload.substr(16);
      client.send_text(R"({"type":"ack","bytes":)" + std::to_string(frame.payload.size() - 16) +
                       "}");
    }
    return header;
  }

  const ChunkInfo& chunk = served_pmesh().manifest.chunks[0];
  ServedFolder folder;
  const std::string id = folder.publish("A small bust");
  const std::string operator_ = bearer(Role::kOperator);
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
  EXPECT_EQ(take(client, chunk.length, bytes)[2], 1) << "the level";
  EXPECT_EQ(bytes, file_bytes(chunk.offset, chunk.length));
  const Json done = Json::parse(client.receive().payload);
  EXPECT_EQ(done["type"], "done");
  EXPECT_EQ(done["bytes"], served_pmesh().manifest.file_bytes);
  EXPECT_EQ(done["triangles"], 8);
}

TEST_F(StreamTest, TheHandshakeBringsTheHeadWhereItIsAskedFor) {
  WebSocketClient client = connect("?head=true");
  const std::size_t head = told(client)["head_bytes"];
  std::string bytes;
  take(client, head, bytes);
  EXPECT_EQ(bytes, file_bytes(0, head));
  EXPECT_THROW(connect("?head=maybe"), std::runtime_error);
}

TEST_F(StreamTest, OneSocketBringsSeveralModels) {
  const TinyPmesh other = tiny_pmesh("another base", "another chunk");
  const std::string second = folder.publish("Another bust", other);
  WebSocketClient client = connect();
  told(client);
  client.send_text(R"({"type":"open","model":5,"id":")" + second + "\"}");
  EXPECT_EQ(told(client)["sha256"], to_hex(sha256(other.bytes)));
  client.send_text(R"({"type":"want","model":5,"level":1})");
  std::string bytes;
  EXPECT_EQ(take(client, other.manifest.chunks[0].length, bytes)[0], 5) << "the model";
  EXPECT_EQ(bytes, "another chunk");
  EXPECT_EQ(told(client)["model"], 5);
  client.send_text(R"({"type":"close","model":5})");
  EXPECT_EQ(told(client)["type"], "closed");
  client.send_text(R"({"type":"open","model":5,"id":"00000000000000000000000001"})");
  EXPECT_EQ(told(client)["reason"], "there is no such model");
}

TEST_F(StreamTest, OpeningModelsIsBoundToTheRateOfRequests) {
  end(daemon);  // only one daemon may use a data folder
  const Daemon strict(folder.path(), {"--request-rate", "1"});
  WebSocketClient client(strict.port(), url(), "pmesh.v1");
  told(client);
  const auto reason = [&] {
    client.send_text(R"({"type":"open","model":5,"id":"00000000000000000000000001"})");
    return told(client)["reason"];
  };
  EXPECT_EQ(reason(), "there is no such model");
  for (int i = 0; i < 100; ++i) {  // the rate limit allows only ten calls at once
    if (reason() == "too many requests; wait") return;
  }
  FAIL() << "a hundred calls were answered";
}

TEST_F(StreamTest, ARequestForTimeIsAnsweredByPromises) {
  WebSocketClient client = connect();
  told(client);
  client.send_text(R"({"type":"want","turn":3,"seconds":5})");
  const Json promise = told(client);
  EXPECT_EQ(promise["type"], "promise");
  EXPECT_EQ(promise["turn"], 3);
  EXPECT_EQ(promise["measured"], false);
  EXPECT_EQ(promise["bytes_per_second"], 32000.0);
}

TEST_F(StreamTest, AClientThatAcknowledgesNothingGetsItsCreditAllTheSame) {
  WebSocketClient client = connect();
  told(client);
  client.send_text(R"({"type":"want","level":1})");
  std::size_t bytes = 0;
  while (bytes < chunk.length)
    bytes += client.receive().payload.size() - 16;
  EXPECT_EQ(told(client)["type"], "done");
}

TEST_F(StreamTest, AClientThatGrantsAheadIsSentEverything) {
  WebSocketClient client = connect();
  told(client);
  client.send_text(R"({"type":"ack","bytes":16777216})");
  client.send_text(R"({"type":"want","level":1})");
  std::size_t bytes = 0;
  while (bytes < chunk.length)
    bytes += client.receive().payload.size() - 16;
  EXPECT_EQ(told(client)["type"], "done");
}

TEST_F(StreamTest, PagesOfOtherSitesMayStreamUnlessSomeAreListed) {
  EXPECT_NO_THROW(connect("", "Origin: https://museum.example\r\n"));
  end(daemon);  // only one daemon may use a data folder
  const Daemon strict(folder.path(), {"--allowed-origins", "https://museum.example"});
  const auto status = [&](const std::string& origin) {
    try {
      WebSocketClient(strict.port(), url(), "pmesh.v1", origin);
    } catch (const std::runtime_error& refused) {
      return std::string(refused.what()).substr(0, 15);
    }
    return std::string("open");
  };
  EXPECT_EQ(status("Origin: https://museum.example\r\n"), "open");
  EXPECT_EQ(status("Origin: http://localhost\r\n"), "open") << "its own pages: the Host";
  EXPECT_EQ(status(""), "open") << "no browser";
  for (const char* const wrong :
       {"https://museum.example.evil.example", "http://museum.example", "null", ""}) {
    EXPECT_EQ(status("Origin: " + std::string(wrong) + "\r\n"), "no upgrade: 403") << wrong;
  }
}

TEST_F(StreamTest, AModelThatWasHiddenIsStreamedNoFurther) {
  WebSocketClient visitor = connect(), owner = connect("", operator_);
  told(visitor), told(owner);
  hide();
  visitor.send_text(R"({"type":"want","level":1})");
  EXPECT_EQ(visitor.receive().close_code(), 1012);
  EXPECT_THROW(connect(), std::runtime_error);
  owner.send_text(R"({"type":"want","level":1})");
  EXPECT_EQ(owner.receive().kind, WebSocketFrame::kBinary);
}

TEST_F(StreamTest, ARevokedTokensStreamEndsWithoutBeingAsked) {
  hide();
  const NewToken token = folder.new_token(Role::kViewer);
  WebSocketClient client = connect("", bearer(token.text)), other = connect("", operator_);
  told(client), told(other);
  const std::string target = "/api/v1/tokens/" + token.id.to_string();
  EXPECT_EQ(http_get(daemon.port(), target, bearer(Role::kAdmin), "DELETE").status, 204);
  EXPECT_EQ(client.receive().close_code(), 1012);
  EXPECT_THROW(connect("", bearer(token.text)), std::runtime_error);
  other.send_text(R"({"type":"want","level":1})");
  EXPECT_EQ(other.receive().kind, WebSocketFrame::kBinary);
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
