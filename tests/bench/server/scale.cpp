// SPDX-License-Identifier: Apache-2.0
#include <poll.h>
#include <sys/epoll.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "medians.h"
#include "sections.h"
#include "support/descriptor_limit.h"
#include "support/process/daemon.h"
#include "support/product_names.h"
#include "support/resident_memory.h"
#include "support/served_folder.h"
#include "viewer.h"

namespace vitrine::bench {
namespace {

using Clock = std::chrono::steady_clock;

// Size of the model's chunk in bytes. No viewer receives that much during a measurement.
constexpr std::size_t kChunk = 64u << 20;

class Scale {
 public:
  Scale()
      : id_(folder_.publish("a scan", test::tiny_pmesh("a base mesh", std::string(kChunk, 'c')))),
        daemon_(folder_.path(), {"--max-connections", "13000", "--max-connections-per-address", "0",
                                 "--request-rate", "0", "--idle-timeout", "3600"}) {
    connect(1);  // the first viewer causes allocations that later viewers share
    viewers_[0].say(R"({"type":"want","level":1})");
    while (viewers_[0].payload() == 0)
      viewers_[0].refine();
    viewers_.clear();
  }

  // Connects `count` more idle viewers. Returns the bytes of resident memory that the daemon needs
  // for each.
  double idle(std::size_t count) {
    const double before = resident();
    connect(count);
    return (resident() - before) / static_cast<double>(count);
  }

  // Makes `count` viewers refine for the duration `time`. Returns the bytes that the slowest and
  // the median viewer received.
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

  // Connects `count` viewers that request everything, acknowledge it and read nothing. Returns how
  // many more bytes of resident memory the daemon needs for each of them than for an idle viewer.
  double never_reading(std::size_t count) {
    connect(count);
    const double before = resident();
    for (Viewer& viewer : viewers_) {
      viewer.say(R"({"type":"ack","bytes":16777216})");
      viewer.say(R"({"type":"want","level":1})");
    }
    double now = before, last = 0;
    while (now > last) {  // ends when the buffers are full
      last = now;
      ::poll(nullptr, 0, 2000);
      now = resident();
    }
    return (now - before) / static_cast<double>(count);
  }

 private:
  // Connects in rounds, so that the kernel's queue of new connections does not overflow.
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
  constexpr double kIdle = 20'000, kOneChunk = 64 * 1024;  // limits in bytes per viewer
  test::raise_descriptor_limit();
  const std::size_t viewers = effort.is_quick ? 1'000 : 10'000, active = viewers / 5;
  {
    Scale scale;
    const double idle = scale.idle(viewers);
    report.add({"idle_viewer", "ratio_to_20_kb", idle, kIdle, idle / kIdle, 1});
    Medians figures;
    for (int run = 0; run < (effort.is_quick ? 1 : 5); ++run) {
      const auto [slowest, usual] =
          scale.refine(active, std::chrono::seconds(effort.is_quick ? 2 : 5));
      figures.add({"refining", "median_ratio_to_slowest", usual, slowest,
                   slowest > 0 ? usual / slowest : kNoThreshold, 2});
    }
    figures.report(report);
  }
  // Uses a new daemon, because a daemon that has had viewers would reuse their memory.
  const double stuck = Scale().never_reading(viewers / 10);
  report.add({"never_reading", "ratio_to_a_chunk", stuck, kOneChunk, stuck / kOneChunk, 1});
}

}  // namespace vitrine::bench
