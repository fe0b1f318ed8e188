// SPDX-License-Identifier: Apache-2.0
// Tests commands that connect to a server that is not Vitrine.
#include <sys/socket.h>

#include <thread>

#include "codec/files/file_descriptor.h"
#include "support/process/loopback.h"
#include "support/product_names.h"
#include "vitrine_command.h"

namespace vitrine::test {
namespace {

// A server that answers every request with the same JSON.
class StrangeServer {
 public:
  explicit StrangeServer(const std::string& body)
      : answer_("HTTP/1.1 200 OK\r\nConnection: close\r\nContent-Length: " +
                std::to_string(body.size()) + "\r\n\r\n" + body),
        socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address = loopback(0);
    socklen_t size = sizeof address;
    EXPECT_EQ(::bind(socket_.get(), reinterpret_cast<sockaddr*>(&address), size), 0);
    EXPECT_EQ(::listen(socket_.get(), 8), 0);
    EXPECT_EQ(::getsockname(socket_.get(), reinterpret_cast<sockaddr*>(&address), &size), 0);
    url_ = "http://127.0.0.1:" + std::to_string(ntohs(address.sin_port));
    thread_ = std::jthread([this] { serve(); });
  }
  ~StrangeServer() { ::shutdown(socket_.get(), SHUT_RDWR); }

  const std::string& url() const { return url_; }

 private:
  void serve() const {
    for (;;) {
      const FileDescriptor peer(::accept(socket_.get(), nullptr, nullptr));
      if (!peer) return;
      char bytes[1024];
      std::string request;
      while (request.find("\r\n\r\n") == std::string::npos) {
        const ssize_t n = ::recv(peer.get(), bytes, sizeof bytes, 0);
        if (n <= 0) break;
        request.append(bytes, static_cast<std::size_t>(n));
      }
      ::send(peer.get(), answer_.data(), answer_.size(), MSG_NOSIGNAL);
      ::shutdown(peer.get(), SHUT_WR);
      while (::recv(peer.get(), bytes, sizeof bytes, 0) > 0) {
      }
    }
  }

  const std::string answer_;
  const FileDescriptor socket_;
  std::string url_;
  std::jthread thread_;
};

TEST_F(VitrineCommand, AResponseOfAnotherServerIsAnErrorAndNoCrash) {
  const StrangeServer server(R"({"models":[1],"id":1,"token":null})");
  expect_fault(vitrine({"doctor", "--url", server.url()}), 1);
  expect_fault(vitrine({"token", "create", "--role", "viewer", "--server", server.url(), "--token",
                        "vtr_a"}),
               1);
}

}  // namespace
}  // namespace vitrine::test
