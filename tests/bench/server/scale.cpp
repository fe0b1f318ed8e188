// SPDX-License-Identifier: Apache-2.0
#include <poll.h>
#include <sys/epoll.h>
#include <sys/socket.h>

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <vector>

#include "../../server/app/served_folder.h"
#include "medians.h"
#include "sections.h"
#include "server/stream/slice.h"
#include "support/daemon.h"
#include "support/descriptor_limit.h"
#include "support/http_client.h"
#include "support/loopback.h"
#include "support/resident_memory.h"

namespace vitrine::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kChunk = 64u << 20;  // more than anybody is sent meanwhile

// One WebSocket that does not block.
class Viewer {
 public:
  Viewer(std::uint16_t port, const std::string& model) : socket_(test::connect_to(port)) {
    send("GET /api/v1/models/" + model +
         "/stream HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
         "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
         "Sec-WebSocket-Protocol: pmesh.v1\r\n\r\n");
  }

  int socket() const { return socket_.get(); }
  std::uint64_t payload() const { return payload_; }

  void send(const std::string& bytes) {
    if (::send(socket(), bytes.data(), bytes.size(), MSG_NOSIGNAL) !=
        static_cast<ssize_t>(bytes.size()))
      throw std::runtime_error("a viewer was cut");
  }
  void say(const std::string& text) { send(test::masked_frame(0x81, text)); }

  // Waits for the greeting.
  void greet() {
    while (buffer_.find("\"type\":\"model\"") == std::string::npos)
      receive(0);
    buffer_.clear();
  }

  // Takes what is there and acknowledges its slices.
  void refine() {
    receive(MSG_DONTWAIT);
    std::size_t at = 0, slices = 0;
    while (const std::size_t length = frame_at(at)) {
      if (buffer_[at] == '\x82') slices += length - 4 - kSliceHeader;
      at += length;
    }
    buffer_.erase(0, at);
    payload_ += slices;
    if (slices > 0) say(R"({"type":"ack","bytes":)" + std::to_string(slices) + "}");
  }

 private:
  void receive(int flags) {
    char bytes[65536];
    const ssize_t count = ::recv(socket(), bytes, sizeof bytes, flags);
    if (count == 0) throw std::runtime_error("a viewer was cut");
    if (count > 0) buffer_.append(bytes, static_cast<std::size_t>(count));
  }

  // The length of the whole frame that starts there; 0 where it is not whole. Slices are longer
  // than 125 bytes and shorter than 64 KiB: their header has 4 bytes; so all else is skipped.
  std::size_t frame_at(std::size_t at) const {
    if (buffer_.size() < at + 4) return 0;
    std::size_t length = static_cast<unsigned char>(buffer_[at + 1]), header = 2;
    if (length == 126) {
      length = static_cast<std::size_t>(static_cast<unsigned char>(buffer_[at + 2])) << 8 |
               static_cast<unsigned char>(buffer_[at + 3]);
      header = 4;
    }
    return buffer_.size() < at + header + length ? 0 : header + length;
  }

  FileDescriptor socket_;
  std::string buffer_;
  std::uint64_t payload_ = 0;
};

class Scale {
 public:
  Scale()
      : id_(folder_.publish("a scan", test::tiny_pmesh("a base mesh", std::string(kChunk, 'c')))),
        daemon_(folder_.path(), {"--max-connections", "13000", "--max-connections-per-address", "0",
                                 "--request-rate", "0", "--idle-timeout", "3600"}) {
    connect(1);  // what the first one costs, all share
    viewers_[0].say(R"({"type":"want","level":1})");
    while (viewers_[0].payload() == 0)
      viewers_[0].refine();
    viewers_.clear();
  }

  // Resident bytes of the daemon for each of `count` more viewers that look on.
  double idle(std::size_t count) {
    const double before = resident();
    connect(count);
    return (resident() - before) / static_cast<double>(count);
  }

  // As many of them refine for that long: the slowest's bytes, and the median's.
  std::pair<double, double> refine(std::size_t count, std::chrono::milliseconds time) {
    const FileDescriptor events(::epoll_create1(EPOLL_CLOEXEC));
    std::vector<std::uint64_t> before;
    for (std::size_t i = 0; i < count; ++i) {
      before.push_back(viewers_[i].payload());
      viewers_[i].say(R"({"type":"want","level":1})");
      epoll_event event{.events = EPOLLIN, .data = {.u64 = i}};
      ::epoll_ctl(events.get(), EPOLL_CTL_ADD, viewers_[i].socket(), &event);
    }
    std::vector<epoll_event> ready(256);
    for (const auto end = Clock::now() + time; Clock::now() < end;) {
      const int found =
          ::epoll_wait(events.get(), ready.data(), static_cast<int>(ready.size()), 100);
      for (int i = 0; i < found; ++i)
        viewers_[ready[static_cast<std::size_t>(i)].data.u64].refine();
    }
    std::vector<double> bytes;
    for (std::size_t i = 0; i < count; ++i)
      bytes.push_back(static_cast<double>(viewers_[i].payload() - before[i]));
    return {*std::ranges::min_element(bytes), median(bytes)};
  }

  // Resident bytes for each of `count` viewers that want everything, grant it and read nothing,
  // beyond what it is as long as they look on.
  double never_reading(std::size_t count) {
    connect(count);
    const double before = resident();
    for (Viewer& viewer : viewers_) {
      viewer.say(R"({"type":"ack","bytes":16777216})");
      viewer.say(R"({"type":"want","level":1})");
    }
    double now = before, last = 0;
    while (now > last) {  // buffers fill
      last = now;
      ::poll(nullptr, 0, 2000);
      now = resident();
    }
    return (now - before) / static_cast<double>(count);
  }

 private:
  // In rounds, so that no more wait to be accepted than the kernel queues.
  void connect(std::size_t count) {
    constexpr std::size_t kRound = 100;
    while (count > 0) {
      const std::size_t first = viewers_.size();
      for (std::size_t i = 0; i < std::min(count, kRound); ++i)
        viewers_.emplace_back(daemon_.port(), id_);
      for (std::size_t i = first; i < viewers_.size(); ++i)
        viewers_[i].greet();
      count -= std::min(count, kRound);
    }
  }

  double resident() const { return static_cast<double>(test::resident_bytes(daemon_.pid())); }

  test::ServedFolder folder_;
  std::string id_;
  test::Daemon daemon_;
  std::vector<Viewer> viewers_;
};

}  // namespace

void scale(Report& report, const Effort& effort) {
  constexpr double kIdle = 20'000, kOneChunk = 64 * 1024;  // bytes each
  test::raise_descriptor_limit();
  const std::size_t viewers = effort.quick ? 1'000 : 10'000, active = viewers / 5;
  {
    Scale scale;
    const double idle = scale.idle(viewers);
    report.add({"idle_viewer", "ratio_to_20_kb", idle, kIdle, idle / kIdle, 1});
    Medians figures;
    for (int run = 0; run < (effort.quick ? 1 : 5); ++run) {
      const auto [slowest, usual] =
          scale.refine(active, std::chrono::seconds(effort.quick ? 2 : 5));
      figures.add({"refining", "median_ratio_to_slowest", usual, slowest,
                   slowest > 0 ? usual / slowest : kNoThreshold, 2});
    }
    figures.report(report);
  }
  // A daemon that never had other viewers, whose memory would serve these.
  const double stuck = Scale().never_reading(viewers / 10);
  report.add({"never_reading", "ratio_to_a_chunk", stuck, kOneChunk, stuck / kOneChunk, 1});
}

}  // namespace vitrine::bench
