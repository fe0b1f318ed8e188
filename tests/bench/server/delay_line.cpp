// SPDX-License-Identifier: Apache-2.0
#include "delay_line.h"
#include "support/product_names.h"

#include <fcntl.h>
#include <linux/if_tun.h>
#include <net/if.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <stdexcept>

namespace vitrine::bench {

FileDescriptor tun_device(const std::string& name) {
  FileDescriptor device(::open("/dev/net/tun", O_RDWR | O_NONBLOCK | O_CLOEXEC));
  ifreq request{};
  name.copy(request.ifr_name, IFNAMSIZ - 1);
  request.ifr_flags = IFF_TUN | IFF_NO_PI;
  if (!device || ::ioctl(device.get(), TUNSETIFF, &request) != 0)
    throw std::runtime_error("cannot make a TUN device; run as root");
  return device;
}

DelayLine::DelayLine(FileDescriptor a, FileDescriptor b, std::chrono::microseconds delay)
    : a_(std::move(a)),
      b_(std::move(b)),
      end_(::eventfd(0, EFD_CLOEXEC)),
      delay_(delay),
      ways_{{a_.get(), b_.get()}, {b_.get(), a_.get()}},
      thread_([this] { run(); }) {}

DelayLine::~DelayLine() {
  ::eventfd_write(end_.get(), 1);
  thread_.join();
}

void DelayLine::Way::take(Clock::time_point due) {
  char bytes[65536];
  for (ssize_t count; (count = ::read(from, bytes, sizeof bytes)) > 0;)
    packets.push_back({due, {bytes, bytes + count}});
}

void DelayLine::Way::give(Clock::time_point now) {
  for (; !packets.empty() && packets.front().due <= now; packets.pop_front()) {
    const std::vector<char>& bytes = packets.front().bytes;
    // A packet that does not fit into the device's queue is lost, as on a real network.
    [[maybe_unused]] const ssize_t written = ::write(to, bytes.data(), bytes.size());
  }
}

DelayLine::Clock::time_point DelayLine::next_due() const {
  auto due = Clock::now() + std::chrono::seconds(1);
  for (const Way& way : ways_) {
    if (!way.packets.empty()) due = std::min(due, way.packets.front().due);
  }
  return due;
}

void DelayLine::run() {
  pollfd ends[] = {{a_.get(), POLLIN, 0}, {b_.get(), POLLIN, 0}, {end_.get(), POLLIN, 0}};
  while ((ends[2].revents & POLLIN) == 0) {
    const auto left = std::chrono::ceil<std::chrono::nanoseconds>(next_due() - Clock::now());
    const timespec timeout{0, std::clamp<long>(left.count(), 0, 999'999'999)};
    ::ppoll(ends, 3, &timeout, nullptr);
    const auto now = Clock::now();
    for (Way& way : ways_) {
      way.take(now + delay_);
      way.give(now);
    }
  }
}

}  // namespace vitrine::bench
