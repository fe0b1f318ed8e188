// SPDX-License-Identifier: Apache-2.0
// Tests what happens to the open streams of a model that is changed. Each client waits up to 20 s
// for the server's close frame, and sends nothing before the frame arrives.
#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "held_object.h"
#include "server/api/routes.h"
#include "server/store/change.h"
#include "support/damage_object.h"
#include "support/hierarchies.h"
#include "support/local_server.h"
#include "support/process/http_client.h"
#include "support/stored_model.h"

namespace vitrine::server {
namespace {

using nlohmann::json;
using test::WebSocketClient;
using test::WebSocketFrame;

constexpr int kServiceRestart = 1012;

std::vector<std::uint8_t> file_of(unsigned size) {
  return test::store_model(test::on_lattice(test::sheet(size, size)), {}).file;
}

class OpenStreams : public testing::Test {
 protected:
  std::string add_model(unsigned size) {
    return publish(server_.store(), server_.catalogue(), file_of(size), {.title = "A"})
        ->id.to_string();
  }
  WebSocketClient open(const std::string& id, const std::string& who = "") {
    WebSocketClient client(server_.port(), "/api/v1/models/" + id + "/stream", "pmesh.v1", who);
    EXPECT_EQ(client.receive().kind, WebSocketFrame::kText);
    return client;
  }
  void change(const std::string& method, const std::string& path, const json& body = nullptr) {
    const std::string text = body.is_null() ? "" : body.dump();
    test::HttpClient client(server_.port());
    client.send(method + " /api/v1/models/" + path + " HTTP/1.1\r\nHost: a\r\n" + operator_ +
                (text.empty() ? "" : "Content-Type: application/json\r\n") +
                "Content-Length: " + std::to_string(text.size()) + "\r\n\r\n" + text);
    EXPECT_LT(client.receive().status, 300) << path;
  }
  void withdraw(const std::string& id) { change("POST", id + "/unpublish"); }

  static void expect_end(WebSocketClient& client) {
    const WebSocketFrame frame = client.receive();
    ASSERT_EQ(frame.kind, WebSocketFrame::kClose);
    EXPECT_EQ(frame.close_code(), kServiceRestart);
  }
  // Expects that the stream answers a detail request. The head of the model alone meets this
  // request.
  static void expect_alive(WebSocketClient& client) {
    client.send_text(R"({"type":"want","level":0})");
    const WebSocketFrame frame = client.receive();
    ASSERT_EQ(frame.kind, WebSocketFrame::kText);
    EXPECT_EQ(json::parse(frame.payload)["type"], "done");
  }
  // Returns once the server has checked all open streams after the changes so far. For this, two
  // streams are ended one after the other. The server notices the end of the second stream in a
  // later round of checks, so the earlier round is then complete.
  void await_check() {
    for (int round = 0; round < 2; ++round) {
      const std::string witness = add_model(12);
      WebSocketClient stream = open(witness);
      withdraw(witness);
      expect_end(stream);
    }
  }

  test::LocalServer server_{public_routes()};
  const std::string operator_ = server_.bearer(Role::kOperator);
  const std::string id_ = add_model(24);
};

TEST_F(OpenStreams, EndIfTheModelIsWithdrawn) {
  WebSocketClient stream = open(id_);
  withdraw(id_);
  expect_end(stream);
}

TEST_F(OpenStreams, EndIfTheModelIsCapped) {
  WebSocketClient stream = open(id_);
  change("PATCH", id_, {{"public_max_level", 0}});
  expect_end(stream);
}

TEST_F(OpenStreams, EndIfTheModelIsDeleted) {
  WebSocketClient stream = open(id_);
  change("DELETE", id_);
  expect_end(stream);
}

TEST_F(OpenStreams, EndIfAnotherProcessReplacesTheFile) {
  WebSocketClient stream = open(id_), of_caller = open(id_, operator_);
  ASSERT_TRUE(
      replace(server_.store(), server_.catalogue(), file_of(30), {}, {.id = ModelId::parse(id_)}));
  expect_end(stream);
  expect_end(of_caller);
}

// A request that arrives before the server has checked the open streams.
TEST_F(OpenStreams, ARequestForDetailAfterTheChangeGetsNoByte) {
  const std::function<void(const std::string&)> changes[] = {
      [this](const std::string& id) { withdraw(id); },
      [this](const std::string& id) {
        change("PATCH", id, {{"public_max_level", 0}});
      },
      [this](const std::string& id) {
        ASSERT_TRUE(replace(server_.store(), server_.catalogue(), file_of(30), {},
                            {.id = ModelId::parse(id)}));
        server_.services().models.refresh();
      }};
  for (const auto& change : changes) {
    const std::string id = add_model(24);
    WebSocketClient stream = open(id);
    change(id);
    stream.send_text(R"({"type":"want","level":255})");
    expect_end(stream);
  }
}

// The catalogue does not change when a file is found damaged, but streams must end.
TEST_F(OpenStreams, EndIfTheFileIsFoundDamaged) {
  WebSocketClient stream = open(id_), of_caller = open(id_, operator_);
  await_check();
  test::damage_object(server_.data(), server_.catalogue().find(*ModelId::parse(id_)).value()->file);
  ASSERT_TRUE(server_.scrubber().check_all());
  expect_end(stream);
  expect_end(of_caller);
}

TEST_F(OpenStreams, EndIfASecondModelOfTheStreamIsWithdrawn) {
  const std::string second = add_model(20);
  WebSocketClient stream = open(id_);
  stream.send_text(json{{"type", "open"}, {"model", 1}, {"id", second}}.dump());
  EXPECT_EQ(stream.receive().kind, WebSocketFrame::kText);
  withdraw(second);
  expect_end(stream);
}

TEST_F(OpenStreams, GoOnIfAModelThatWasClosedIsWithdrawn) {
  const std::string second = add_model(20);
  WebSocketClient stream = open(id_);
  stream.send_text(json{{"type", "open"}, {"model", 1}, {"id", second}}.dump());
  EXPECT_EQ(stream.receive().kind, WebSocketFrame::kText);
  stream.send_text(R"({"type":"close","model":1})");
  EXPECT_EQ(stream.receive().kind, WebSocketFrame::kText);
  withdraw(second);
  await_check();
  expect_alive(stream);
}

TEST_F(OpenStreams, GoOnIfOnlyTextsChange) {
  WebSocketClient stream = open(id_);
  change("PATCH", id_, {{"title", "B"}});
  await_check();
  expect_alive(stream);
}

// The changed model is no longer cached, but the check of its stream must not open its file.
TEST_F(OpenStreams, AFileThatTakesLongToOpenDelaysTheEndOfNoStream) {
  WebSocketClient stream = open(id_);
  ModelRecord model = server_.catalogue().find(*ModelId::parse(id_)).value().value();
  test::HeldObject held(server_.data(), model.file);
  model.title = "B";
  ASSERT_TRUE(server_.catalogue().update(model, std::nullopt));
  await_check();
  held.release();
  expect_alive(stream);
}

TEST_F(OpenStreams, OfCallersWithATokenGoOnIfTheModelIsCappedOrWithdrawn) {
  WebSocketClient stream = open(id_, operator_);
  change("PATCH", id_, {{"public_max_level", 0}});
  withdraw(id_);
  await_check();
  expect_alive(stream);
}

}  // namespace
}  // namespace vitrine::server
