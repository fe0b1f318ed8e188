// SPDX-License-Identifier: Apache-2.0
#include "load.h"

#include <sys/epoll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <memory>
#include <stdexcept>
#include <string_view>

#include "support/process/loopback.h"
#include "support/product_names.h"

namespace vitrine::bench {
namespace {

using Clock = std::chrono::steady_clock;

std::uint64_t content_length(std::string_view head) {
  constexpr std::string_view kName = "\r\nContent-Length: ";
  const std::size_t at = head.find(kName);
  std::uint64_t length = 0;
  if (at != std::string_view::npos)
    std::from_chars(head.data() + at + kName.size(), head.data() + head.size(), length);
  return length;
}

class Visitor {
 public:
  explicit Visitor(std::uint16_t port) : socket_(test::connect_to(port)) {}

  int socket() const { return socket_.get(); }
  Clock::time_point asked() const { return asked_; }

  void ask(std::string_view request) {
    asked_ = Clock::now();
    got_ = left_ = 0;
    if (::send(socket(), request.data(), request.size(), MSG_NOSIGNAL) !=
        static_cast<ssize_t>(request.size())) {
      throw std::runtime_error("the server has closed a connection");
    }
  }

  // Reads the available bytes; returns true once the response is complete.
  bool take(int status) {
    if (left_ == 0 && !take_head(status)) return false;
    while (left_ > 0) {
      const ssize_t count = ::recv(socket(), nullptr, left_, MSG_TRUNC | MSG_DONTWAIT);
      if (count < 0 && errno == EAGAIN) return false;
      if (count <= 0) throw std::runtime_error("an answer was cut short");
      left_ -= static_cast<std::uint64_t>(count);
    }
    return true;
  }

 private:
  bool take_head(int status) {
    const ssize_t count = ::recv(socket(), head_.data() + got_, head_.size() - got_, MSG_DONTWAIT);
    if (count < 0 && errno == EAGAIN) return false;
    if (count <= 0) throw std::runtime_error("the server has closed a connection");
    got_ += static_cast<std::size_t>(count);
    const std::string_view text(head_.data(), got_);
    const std::size_t end = text.find("\r\n\r\n");
    if (end == std::string_view::npos) return false;
    if (text.substr(9, 3) != std::to_string(status))
      throw std::runtime_error("another status: " + std::string(text.substr(0, end)));
    left_ = status == 304 ? 0 : content_length(text.substr(0, end + 2)) - (got_ - end - 4);
    return true;
  }

  FileDescriptor socket_;
  Clock::time_point asked_;
  std::array<char, 1024> head_;
  std::size_t got_ = 0;
  std::uint64_t left_ = 0;
};

double percentile(std::vector<double>& seconds, double part) {
  const auto at = static_cast<std::ptrdiff_t>(part * static_cast<double>(seconds.size() - 1));
  std::ranges::nth_element(seconds, seconds.begin() + at);
  return seconds[static_cast<std::size_t>(at)];
}

}  // namespace

Delivery deliver(const Load& load) {
  const FileDescriptor epoll(::epoll_create1(EPOLL_CLOEXEC));
  std::vector<std::unique_ptr<Visitor>> visitors;
  std::size_t next = 0;
  const auto request = [&] { return load.requests[next++ % load.requests.size()]; };
  for (std::size_t i = 0; i < load.connections; ++i) {
    visitors.push_back(std::make_unique<Visitor>(load.port));
    epoll_event event{.events = EPOLLIN, .data = {.ptr = visitors.back().get()}};
    ::epoll_ctl(epoll.get(), EPOLL_CTL_ADD, visitors.back()->socket(), &event);
    visitors.back()->ask(request());
  }
  std::vector<double> times;
  std::array<epoll_event, 64> events;
  const auto start = Clock::now();
  auto now = start;
  while (now < start + load.time) {
    const int ready = ::epoll_wait(epoll.get(), events.data(), events.size(), 5000);
    if (ready == 0) throw std::runtime_error("the server does not answer");
    for (int i = 0; i < ready; ++i) {
      auto& visitor = *static_cast<Visitor*>(events[static_cast<std::size_t>(i)].data.ptr);
      if (!visitor.take(load.status)) continue;
      now = Clock::now();
      times.push_back(std::chrono::duration<double>(now - visitor.asked()).count());
      visitor.ask(request());
    }
  }
  const std::chrono::duration<double> took = now - start;
  return {static_cast<double>(times.size()) / took.count(), percentile(times, 0.5),
          percentile(times, 0.99), times.size()};
}

}  // namespace vitrine::bench
