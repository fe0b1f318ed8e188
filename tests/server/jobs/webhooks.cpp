// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/webhooks.h"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <string>

#include "codec/files/file_descriptor.h"

namespace vitrine {
namespace {

using testing::HasSubstr;

// The museum's own server: hears one request at a time.
class Listener {
 public:
  Listener() : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    EXPECT_EQ(::bind(socket_.get(), reinterpret_cast<sockaddr*>(&address), size), 0);
    EXPECT_EQ(::listen(socket_.get(), 8), 0);
    EXPECT_EQ(::getsockname(socket_.get(), reinterpret_cast<sockaddr*>(&address), &size), 0);
    host_ = "127.0.0.1:" + std::to_string(ntohs(address.sin_port));
  }
  const std::string& host() const { return host_; }

  std::string hear(const std::string& status) {
    const FileDescriptor peer(::accept(socket_.get(), nullptr, nullptr));
    std::string request;
    char buffer[1024];
    while (!request.ends_with("}")) {
      const ssize_t n = ::read(peer.get(), buffer, sizeof buffer);
      if (n <= 0) break;
      request.append(buffer, static_cast<std::size_t>(n));
    }
    const std::string answer =
        "HTTP/1.1 " + status + "\r\nContent-Length: 0\r\nConnection: close\r\n\r\n";
    EXPECT_EQ(::write(peer.get(), answer.data(), answer.size()),
              static_cast<ssize_t>(answer.size()));
    return request;
  }

 private:
  FileDescriptor socket_;
  std::string host_;
};

TEST(Webhooks, OnlyHostsThatAreNamedAreTold) {
  const Log log = Log::open("").value();
  const Webhooks hooks({"museum.example", "127.0.0.1:81"}, log);
  EXPECT_TRUE(hooks.allows("https://museum.example/told?x=1"));
  EXPECT_TRUE(hooks.allows("http://127.0.0.1:81"));
  for (const char* url : {"http://127.0.0.1/", "http://127.0.0.1:810/", "http://localhost:81/",
                          "http://museum.example@evil.example/", "http://museum.example.evil/",
                          "http://evil.example/?http://museum.example/", "file:///etc/passwd",
                          "http://[::1]:81/", "gopher://museum.example/", "http://", ""})
    EXPECT_FALSE(hooks.allows(url)) << url;
  EXPECT_FALSE(Webhooks({}, log).allows("http://museum.example/"));
}

TEST(Webhooks, AreTriedAgainUntilTheyAreTaken) {
  const Log log = Log::open("").value();
  Listener listener;
  Webhooks hooks({listener.host()}, log);
  hooks.tell("http://" + listener.host() + "/told", R"({"state":"done"})");
  const std::string first = listener.hear("503 Busy");
  EXPECT_THAT(first, HasSubstr("POST /told HTTP/1.1\r\n"));
  EXPECT_THAT(first, HasSubstr("Content-Type: application/json\r\n"));
  EXPECT_TRUE(first.ends_with("\r\n\r\n{\"state\":\"done\"}"));
  EXPECT_EQ(listener.hear("204 Taken"), first);
  hooks.tell("http://" + listener.host() + "/next", "{}");
  EXPECT_THAT(listener.hear("200 OK"), HasSubstr("POST /next"));
}

TEST(Webhooks, DoNotHoldUpTheEnd) {
  const Log log = Log::open("").value();
  Listener listener;
  Webhooks hooks({listener.host()}, log);
  for (int i = 0; i < 10; ++i)
    hooks.tell("http://" + listener.host() + "/told", "{}");
  listener.hear("500 No");
  hooks.stop();  // and does not try the others
}

}  // namespace
}  // namespace vitrine
