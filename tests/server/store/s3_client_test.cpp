// SPDX-License-Identifier: Apache-2.0
// Tests the S3 client against a store with the failures that real stores sometimes have.
#include "server/store/s3_client.h"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <thread>

#include "codec/files/file_descriptor.h"
#include "server/store/s3_store.h"
#include "support/temporary_folder.h"

namespace vitrine::server {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// A store that sends one scripted response on each connection, and then closes the connection.
class ScriptedStore {
 public:
  explicit ScriptedStore(std::vector<std::string> answers)
      : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    EXPECT_EQ(::bind(socket_.get(), reinterpret_cast<sockaddr*>(&address), size), 0);
    EXPECT_EQ(::listen(socket_.get(), 8), 0);
    EXPECT_EQ(::getsockname(socket_.get(), reinterpret_cast<sockaddr*>(&address), &size), 0);
    origin_ = "http://127.0.0.1:" + std::to_string(ntohs(address.sin_port));
    thread_ = std::thread([this, answers = std::move(answers)] {
      for (const std::string& answer : answers)
        give(answer);
    });
  }
  ~ScriptedStore() { thread_.join(); }
  const std::string& origin() const { return origin_; }

 private:
  void give(const std::string& answer) {
    const FileDescriptor peer(::accept(socket_.get(), nullptr, nullptr));
    std::string request;
    char buffer[4096];
    while (request.find("\r\n\r\n") == std::string::npos) {
      const ssize_t n = ::read(peer.get(), buffer, sizeof buffer);
      if (n <= 0) return;
      request.append(buffer, static_cast<std::size_t>(n));
    }
    EXPECT_THAT(request, HasSubstr("AWS4-HMAC-SHA256"));
    EXPECT_EQ(::send(peer.get(), answer.data(), answer.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(answer.size()));
  }

  FileDescriptor socket_;
  std::string origin_;
  std::thread thread_;
};

std::string answer(const std::string& status, const std::string& body, std::size_t more = 0) {
  return "HTTP/1.1 " + status +
         "\r\nConnection: close\r\nContent-Length: " + std::to_string(body.size() + more) +
         "\r\n\r\n" + body;
}

const std::string kSlowDown = answer("503 Slow Down", "<Error><Code>SlowDown</Code></Error>");

class S3ClientTest : public testing::Test {
 protected:
  S3Client client(const ScriptedStore& store) {
    return {S3Address::parse("s3://models?endpoint=" + store.origin()).value(),
            {"museum", "secret"},
            {.pause = [this](std::chrono::milliseconds time) { waits_.push_back(time); }}};
  }
  std::vector<std::chrono::milliseconds> waits_;
};

TEST_F(S3ClientTest, ABusyStoreIsRetriedAfterARandomPause) {
  const ScriptedStore store({kSlowDown, kSlowDown, answer("200 OK", "here")});
  const auto got = client(store).ask({.key = "a"});
  ASSERT_TRUE(got);
  EXPECT_EQ(got->status, 200);
  EXPECT_EQ(got->body, "here");
  ASSERT_EQ(waits_.size(), 2u);
  EXPECT_LE(waits_[0], std::chrono::milliseconds(100));
  EXPECT_LE(waits_[1], std::chrono::milliseconds(200));
}

TEST_F(S3ClientTest, RetriesEnd) {
  const ScriptedStore store(std::vector<std::string>(5, kSlowDown));
  auto s3 = client(store);
  const auto got = s3.ask({.key = "a"});
  ASSERT_TRUE(got);
  EXPECT_EQ(got->status, 503);
  EXPECT_EQ(waits_.size(), 4u);
  EXPECT_THAT(s3.refused("read an object", *got).value().message,
              HasSubstr("cannot read an object in s3://models: " + store.origin() +
                        " answers 503 SlowDown; try again later"));
}

TEST_F(S3ClientTest, APermanentRefusalIsNotRetried) {
  const ScriptedStore store({answer("403 Forbidden", "<Error><Code>AccessDenied</Code></Error>")});
  EXPECT_EQ(client(store).ask({.key = "a"})->status, 403);
  EXPECT_TRUE(waits_.empty());
}

TEST_F(S3ClientTest, AResponseThatIsCutShortIsRequestedAgain) {
  const ScriptedStore store({answer("200 OK", "hal", 3), answer("200 OK", "halves")});
  std::string body;
  const auto got = client(store).ask({.key = "a",
                                      .take =
                                          [&](std::span<const std::uint8_t> bytes) {
                                            body.append(bytes.begin(), bytes.end());
                                            return true;
                                          },
                                      .restart = [&] { body.clear(); }});
  ASSERT_TRUE(got);
  EXPECT_EQ(body, "halves");
  EXPECT_EQ(waits_.size(), 1u);
}

TEST_F(S3ClientTest, AResponseThatIsAlwaysCutShortIsAnError) {
  const ScriptedStore store(std::vector<std::string>(5, answer("200 OK", "hal", 3)));
  const auto got = client(store).ask({.key = "a"});
  ASSERT_FALSE(got);
  EXPECT_EQ(got.error().code, ErrorCode::kIo);
}

TEST_F(S3ClientTest, WhileTheStoreIsUnreachableRequestsAreSentOnce) {
  S3Client s3{S3Address::parse("s3://models?endpoint=http://127.0.0.1:1").value(),
              {"museum", "secret"},
              {.pause = [this](std::chrono::milliseconds time) { waits_.push_back(time); }}};
  EXPECT_FALSE(s3.ask({.key = "a"}));
  EXPECT_EQ(waits_.size(), 4u);
  EXPECT_FALSE(s3.ask({.key = "a"}));
  EXPECT_EQ(waits_.size(), 4u);
}

std::string url_of(const std::string& address) {
  return S3Address::parse(address).value().url_of("a/b", "x=1");
}

TEST(S3Address, ABucketIsInThePathOrInTheHostsName) {
  EXPECT_EQ(url_of("s3://b?endpoint=http://h:9"), "http://h:9/b/a/b?x=1");
  EXPECT_EQ(url_of("s3://b/p/q?endpoint=http://h:9/"), "http://h:9/b/p/q/a/b?x=1");
  EXPECT_EQ(url_of("s3://b/p/?endpoint=http://h:9&style=virtual"), "http://b.h:9/p/a/b?x=1");
  EXPECT_EQ(url_of("s3://b?region=eu-central-1"),
            "https://b.s3.eu-central-1.amazonaws.com/a/b?x=1");
  EXPECT_EQ(S3Address::parse("s3://b/p?endpoint=http://h").value().url_of("", "x=1"),
            "http://h/b?x=1");
}

TEST(S3Address, AnInvalidPartIsNamed) {
  for (const char* odd : {"http://b", "s3://", "s3://?endpoint=http://h", "s3://b?endpoint=ftp://h",
                          "s3://b?endpoint=http://h/path", "s3://b?style=up", "s3://b?colour=red",
                          "s3://b?region=", "s3://b/%20"})
    EXPECT_FALSE(S3Address::parse(odd)) << odd;
}

}  // namespace
}  // namespace vitrine::server
