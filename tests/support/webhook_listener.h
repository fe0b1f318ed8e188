// SPDX-License-Identifier: Apache-2.0
// A server that receives webhooks. Accepts one request at a time, and waits at most 60 s for each.
#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <string>

#include "codec/files/file_descriptor.h"
#include "support/product_names.h"
#include "support/uninterrupted.h"

namespace vitrine::test {

class WebhookListener {
 public:
  WebhookListener() : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    const timeval timeout{.tv_sec = 60, .tv_usec = 0};
    ::setsockopt(socket_.get(), SOL_SOCKET, SO_RCVTIMEO, &timeout, sizeof timeout);
    EXPECT_EQ(::bind(socket_.get(), reinterpret_cast<sockaddr*>(&address), size), 0);
    EXPECT_EQ(::listen(socket_.get(), 8), 0);
    EXPECT_EQ(::getsockname(socket_.get(), reinterpret_cast<sockaddr*>(&address), &size), 0);
    host_ = "127.0.0.1:" + std::to_string(ntohs(address.sin_port));
  }
  const std::string& host() const { return host_; }

  // Accepts the next request. A POST must have a JSON object as its body; other requests have none.
  // The client gets no response until the returned descriptor is closed.
  FileDescriptor accept(std::string& request) {
    FileDescriptor peer(uninterrupted([&] { return ::accept(socket_.get(), nullptr, nullptr); }));
    char buffer[1024];
    const auto ends = [&] {
      return request.ends_with("}") ||
             (!request.starts_with("POST ") && request.ends_with("\r\n\r\n"));
    };
    while (!ends()) {
      const ssize_t n = ::read(peer.get(), buffer, sizeof buffer);
      if (n <= 0) break;
      request.append(buffer, static_cast<std::size_t>(n));
    }
    return peer;
  }

  static void answer(const FileDescriptor& peer, const std::string& status,
                     const std::string& body = "") {
    const std::string text = "HTTP/1.1 " + status +
                             "\r\nContent-Length: " + std::to_string(body.size()) +
                             "\r\nConnection: close\r\n\r\n" + body;
    EXPECT_EQ(::write(peer.get(), text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }

  std::string hear(const std::string& status) {
    std::string request;
    answer(accept(request), status);
    return request;
  }

 private:
  FileDescriptor socket_;
  std::string host_;
};

}  // namespace vitrine::test
