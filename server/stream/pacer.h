// SPDX-License-Identifier: Apache-2.0
// Congestion control for one connection: measures its rate and limits the bytes in flight. Keeps
// enough bytes in flight to fill the link and a short queue. The link is thus always busy, but a
// new request is delayed only briefly. The rate is measured end to end, from the client's
// acknowledgements, so that buffers of proxies do not distort it. Connections that compete for the
// same link or processor converge to equal shares. Does no I/O and reads no clock: the caller
// passes the time.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

namespace vitrine::server {

class Pacer {
 public:
  using Duration = std::chrono::duration<double>;  // seconds
  using Time = std::chrono::time_point<std::chrono::steady_clock, Duration>;

  // The rate assumed before the first measurement: bytes per second of a slow mobile link.
  static constexpr double kFirstGuess = 32'000;

  void sent(std::uint64_t bytes, Time now);
  void arrived(std::uint64_t bytes, Time now);  // records that the client has acknowledged `bytes`

  std::uint64_t in_flight() const { return sent_ - arrived_; }

  // Sets the connection's own round-trip time. Call it only if that time was measured without the
  // queues of other streams.
  void know_delay(Duration own) { own_ = own; }

  // Returns the size in bytes of the slice that may be sent now, or 0 if none may be sent.
  // `busy_streams` is the number of connections with bytes in flight, including this one. If no
  // bytes were sent and none arrived for the time kNudge, allows a slice in any case, because the
  // client may wait for more slices before it acknowledges.
  std::uint32_t room(Time now, std::size_t busy_streams);

  bool is_measured() const { return is_measured_; }
  // Returns the rate in bytes per second over the last kWindow of time with bytes in flight. The
  // rate falls while nothing arrives.
  double rate(Time now) const;
  // Whether the rate is dropping: a slice is late, or the newest part of the window is much slower
  // than the whole window. In this case, it is unknown how low rate() will fall.
  bool is_falling(Time now) const;

  // Returns an optimistic rate. Before the first measurement, it is an estimate from the few bytes
  // seen so far, so that a client receives something at once. During a stall, and until the stall
  // has left the measurement window, it is the rate before the stall, because the connection may
  // recover. Otherwise it equals rate().
  double hope(Time now) const;

  static constexpr Duration kNudge{0.25};

 private:
  static constexpr Duration kWindow{0.4};
  // Minimum duration of a measurement. A shorter burst would measure buffers, not the link.
  static constexpr Duration kLeastTime{0.2};
  static constexpr Duration kSample{0.02};  // minimum interval between samples
  static constexpr Duration kSliceTime{0.04};
  // Processor time per slice, which does not depend on its length.
  static constexpr Duration kSliceCost{50e-6};
  // Time that bytes may queue on slow links, beyond the link's own delay.
  static constexpr Duration kQueue{0.1};
  // Time that bytes may queue on fast links, beyond the link's own delay.
  static constexpr Duration kFastQueue{0.04};
  static constexpr double kFastExtra = 6 * 1024;  // additional bytes that may queue on fast links
  // The limit on the bytes in flight (window_) grows while the queueing delay is shorter than this.
  static constexpr Duration kShortQueue{0.03};
  static constexpr Duration kBaseAge{10};  // interval at which the link's delay is measured again
  // Number of arrived bytes that suffices for a measurement.
  static constexpr std::uint64_t kEnough = 64 * 1024;
  static constexpr std::size_t kMostMarks = 64;
  static constexpr double kFirstWindow = 16 * 1024;
  static constexpr double kLeastWindow = 4 * 1024;
  static constexpr double kMostWindow = 16 << 20;
  // Number of bytes that all connections together may have in flight, in addition to the bytes that
  // each connection's own delay and queue require. If a connection's own delay is unknown, the
  // larger limit kUnknownShared applies, so that distant clients behind a proxy are not slowed
  // down.
  static constexpr double kShared = 256 * 1024, kUnknownShared = 8 << 20;

  struct Mark {
    std::uint64_t end;  // bytes sent up to and including this slice
    Time at;
  };
  struct Sample {
    Duration busy;
    std::uint64_t arrived;
  };

  static double queue_bytes(double rate);
  std::uint32_t slice_bytes(double rate) const;
  Duration busy(Time now) const;
  void advance(Time now);
  void add_sample();
  void note_silence(Time now);
  Duration measure_delay(Time now);

  std::uint64_t sent_ = 0, arrived_ = 0;
  Time then_{};              // time up to which busy_ is counted
  Duration busy_{0};         // total time with bytes in flight, up to then_
  Time progress_{};          // time of the last send or arrival
  std::vector<Mark> marks_;  // the slices in flight, in order
  std::vector<Sample> samples_;
  bool is_measured_ = false;
  double steady_ = 0;      // the rate while the link does not stall, in bytes per second
  Time heard_{};           // time of the last arrival, or of a send with nothing in flight
  Duration recovered_{0};  // value of busy_ at the end of the last stall
  Duration base_ = Duration::max();  // the shortest round trip to the client; max(): not known
  Time base_since_{};
  // If true, room() allows no slice until the bytes in flight have arrived, so that base_ is
  // measured without a queue.
  bool drains_ = false;
  // The connection's own round-trip time, without queues; nullopt if unknown.
  std::optional<Duration> own_;
  double window_ = kFirstWindow;
  // Time that sending one slice should take. It increases with the number of busy streams, because
  // each slice costs processor time.
  Duration slice_time_ = kSliceTime;
};

}  // namespace vitrine::server
