// SPDX-License-Identifier: Apache-2.0
// Tests the real listener against [RFC6455]. The tests follow the groups of the Autobahn test
// suite: 1 framing, 2 pings, 3 reserved bits, 4 opcodes, 5 fragments, 6 UTF-8, 7 closing, 9 limits,
// 10 many frames.
#include <gtest/gtest.h>

#include <csignal>

#include "support/process/daemon.h"
#include "support/process/http_client.h"
#include "support/product_names.h"
#include "support/served_folder.h"

namespace vitrine::test {
namespace {

constexpr std::uint8_t kFin = 0x80, kContinuation = 0, kText = 1, kClose = 8, kPing = 9, kPong = 10;

class Rfc6455Test : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new ServedFolder;
    url_ = "/api/v1/models/" + folder_->publish("A small bust") + "/stream";
    daemon_ = new Daemon(folder_->path());
  }
  static void TearDownTestSuite() {
    daemon_->signal(SIGTERM);
    const ProgramResult end = daemon_->wait();
    EXPECT_EQ(end.exit_code, 0);
    EXPECT_EQ(end.output.find("error"), std::string::npos) << end.output;
    delete daemon_;
    delete folder_;
  }

  // A client that has received the server's greeting.
  struct GreetedClient : WebSocketClient {
    GreetedClient() : WebSocketClient(daemon_->port(), url_, "pmesh.v1") {
      EXPECT_EQ(receive().kind, WebSocketFrame::kText);
    }
  };

  // Returns a valid message of `length` bytes that has no effect on the stream.
  static std::string message(std::size_t length) {
    std::string text = R"({"type":"ack","bytes":1})";
    text.resize(length, ' ');
    return text;
  }

  // Expects that the server has found no fault in the client's frames and still answers pings.
  static void expect_alive(WebSocketClient& client) {
    client.send(kFin | kPing, "still there");
    const WebSocketFrame answer = client.receive();
    EXPECT_EQ(answer.kind, WebSocketFrame::kPong) << answer.payload;
    EXPECT_EQ(answer.payload, "still there");
  }

  // Expects that the next frame closes the connection with `code`.
  static void expect_close(WebSocketClient& client, int code) {
    const WebSocketFrame frame = client.receive();
    ASSERT_EQ(frame.kind, WebSocketFrame::kClose);
    EXPECT_EQ(frame.close_code(), code) << frame.payload.substr(2);
    EXPECT_TRUE(client.is_closed());
  }
  // Sends `bytes` on a new connection. Expects that the server closes it with `code`.
  static void expect_fault(const std::string& bytes, int code) {
    GreetedClient client;
    client.send_raw(bytes);
    expect_close(client, code);
  }

  static std::uint8_t byte(int value) { return static_cast<std::uint8_t>(value); }
  static std::string code(int number) {
    return {static_cast<char>(number >> 8), static_cast<char>(number)};
  }

  static inline ServedFolder* folder_;
  static inline Daemon* daemon_;
  static inline std::string url_;
};

TEST_F(Rfc6455Test, TakesPayloadsOfEveryLengthField) {
  GreetedClient client;
  for (const std::size_t length : {24u, 125u, 126u, 127u, 128u, 65535u, 65536u}) {
    client.send_text(message(length));
    expect_alive(client);
  }
}

TEST_F(Rfc6455Test, TakesAFrameByteByByte) {
  GreetedClient client;
  const std::string text =
      masked_frame(kFin | kText, message(24)) + masked_frame(kFin | kPing, "p");
  for (const char byte : text)
    client.send_raw({&byte, 1});
  EXPECT_EQ(client.receive().payload, "p");
}

TEST_F(Rfc6455Test, Unmasks) {
  GreetedClient client;
  client.send_raw({"\x89\x84\x01\x02\x03\x04\x60\x60\x60\x60", 10});
  EXPECT_EQ(client.receive().payload, "abcd");
}

TEST_F(Rfc6455Test, RefusesFramesThatAreNotMasked) {
  expect_fault({"\x89\x00", 2}, 1002);
}

TEST_F(Rfc6455Test, RefusesALengthInALongerFieldThanItNeeds) {
  expect_fault({"\x81\xfe\x00\x05\0\0\0\0hello", 13}, 1002);
  expect_fault({"\x81\xff\0\0\0\0\0\0\x00\x05\0\0\0\0hello", 19}, 1002);
}

TEST_F(Rfc6455Test, AnswersPingsWithTheirPayload) {
  GreetedClient client;
  for (const std::string& payload : {std::string(), std::string("hello"),
                                     std::string("\x00\xff\xfe\xfd", 4), std::string(125, 'p')}) {
    client.send(kFin | kPing, payload);
    const WebSocketFrame answer = client.receive();
    EXPECT_EQ(answer.kind, WebSocketFrame::kPong);
    EXPECT_EQ(answer.payload, payload);
  }
}

TEST_F(Rfc6455Test, RefusesAPingThatIsTooLong) {
  GreetedClient client;
  client.send(kFin | kPing, std::string(126, 'p'));
  expect_close(client, 1002);
}

TEST_F(Rfc6455Test, IgnoresPongsThatItHasNotAskedFor) {
  GreetedClient client;
  client.send(kFin | kPong, "");
  client.send(kFin | kPong, "unasked");
  expect_alive(client);
}

TEST_F(Rfc6455Test, RefusesReservedBits) {
  for (const int bits : {0x10, 0x20, 0x30, 0x40, 0x50, 0x60, 0x70}) {
    expect_fault(masked_frame(byte(kFin | bits | kText), message(24)), 1002);
    expect_fault(masked_frame(byte(kFin | bits | kPing), ""), 1002);
  }
}

TEST_F(Rfc6455Test, RefusesReservedOpcodes) {
  for (const int opcode : {3, 4, 5, 6, 7, 11, 12, 13, 14, 15})
    expect_fault(masked_frame(byte(kFin | opcode), ""), 1002);
}

TEST_F(Rfc6455Test, JoinsFragmentsAndAnswersPingsInBetween) {
  GreetedClient client;
  const std::string text = message(24);
  client.send(kText, text.substr(0, 10));
  expect_alive(client);
  client.send(kContinuation, "");
  client.send(kContinuation, text.substr(10, 5));
  client.send(kFin | kContinuation, text.substr(15));
  expect_alive(client);
}

TEST_F(Rfc6455Test, JoinsAFragmentForEachByte) {
  GreetedClient client;
  const std::string text = message(200);
  client.send(kText, text.substr(0, 1));
  for (std::size_t i = 1; i < text.size(); ++i)
    client.send(kContinuation, text.substr(i, 1));
  client.send(kFin | kContinuation, "");
  expect_alive(client);
}

TEST_F(Rfc6455Test, RefusesFragmentsOutOfPlace) {
  expect_fault(masked_frame(kPing, "half"), 1002);
  expect_fault(masked_frame(kContinuation, "of nothing"), 1002);
  expect_fault(masked_frame(kFin | kContinuation, "of nothing"), 1002);
  expect_fault(masked_frame(kText, "{") + masked_frame(kFin | kText, message(24)), 1002);
  expect_fault(masked_frame(kFin | kText, message(24)) + masked_frame(kFin | kContinuation, "late"),
               1002);
}

TEST_F(Rfc6455Test, TakesUtf8AndNothingElse) {
  GreetedClient client;
  client.send_text("{\"type\":\"ack\",\"bytes\":1,\"note\":\"κόσμε \xf4\x8f\xbf\xbf\"}");
  client.send(kText, "{\"type\":\"ack\",\"bytes\":1,\"note\":\"\xce");
  client.send(kFin | kContinuation, "\xba\"}");  // one character split over two fragments
  expect_alive(client);
  for (const char* const bad : {"\xff", "\xc0\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xce",
                                "\xf8\x88\x80\x80\x80", "\x80", "ok \xe0\x80\xaf"}) {
    expect_fault(masked_frame(kFin | kText, bad), 1007);
  }
  expect_fault(masked_frame(kText, "\xce") + masked_frame(kFin | kContinuation, "x"), 1007);
}

TEST_F(Rfc6455Test, AnswersAClose) {
  GreetedClient client;
  client.send(kFin | kClose, "");
  EXPECT_EQ(client.receive().kind, WebSocketFrame::kClose);
  EXPECT_TRUE(client.is_closed());
}

TEST_F(Rfc6455Test, AnswersACloseWithItsCode) {
  for (const int number :
       {1000, 1001, 1002, 1003, 1007, 1008, 1009, 1010, 1011, 3000, 3999, 4000, 4999}) {
    GreetedClient client;
    client.send(kFin | kClose, code(number) + std::string(123, 'r'));
    expect_close(client, number);
  }
}

TEST_F(Rfc6455Test, IgnoresWhatFollowsAClose) {
  GreetedClient client;
  client.send_raw(masked_frame(kFin | kClose, code(1000)) + masked_frame(kFin | kPing, "late"));
  expect_close(client, 1000);
}

TEST_F(Rfc6455Test, RefusesCloseFramesThatAreNone) {
  expect_fault(masked_frame(kFin | kClose, "x"), 1002);
  for (const int number : {0, 999, 1004, 1005, 1006, 1016, 1100, 2000, 2999})
    expect_fault(masked_frame(kFin | kClose, code(number)), 1002);
  GreetedClient client;
  client.send(kFin | kClose, code(1000) + std::string(124, 'r'));
  expect_close(client, 1002);
}

TEST_F(Rfc6455Test, RefusesMessagesThatAreTooLongHoweverTheyCome) {
  GreetedClient whole;
  whole.send_text(message(64 * 1024 + 1));
  expect_close(whole, 1009);
  GreetedClient parts;
  parts.send(kText, message(60'000));
  parts.send(kFin | kContinuation, std::string(6'000, ' '));
  expect_close(parts, 1009);
  // A frame that claims to be long is refused at once. The server does not wait for its payload.
  expect_fault({"\x81\xff\x00\x00\x00\xff\xff\xff\xff\xff\0\0\0\0", 14}, 1009);
}

}  // namespace
}  // namespace vitrine::test
