// SPDX-License-Identifier: Apache-2.0
// How fast a connection is, and so how much may be on its way: as much as the link holds and a
// short queue keeps it busy, so that a new wish waits for little. Measured from end to end, by what
// the client acknowledges; no proxy's buffers deceive it. Connections that wait for the same link
// or processor come to equal shares of it. Pure: the caller tells the time.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

namespace vitrine {

class Pacer {
 public:
  using Duration = std::chrono::duration<double>;  // seconds
  using Time = std::chrono::time_point<std::chrono::steady_clock, Duration>;

  // What a connection is taken for before it is measured: bytes per second of a slow mobile link.
  static constexpr double kFirstGuess = 32'000;

  void sent(std::uint64_t bytes, Time now);
  void arrived(std::uint64_t bytes, Time now);  // of those sent

  std::uint64_t in_flight() const { return sent_ - arrived_; }

  // The connection's own delay, where that is known from beside: no crowd's queue is in it.
  void know_delay(Duration own) { own_ = own; }

  // Bytes of the slice that may follow; 0 where none may. `crowd` is how many connections have
  // something on their way, this one included. Where nothing has arrived for kNudge a slice may
  // follow in any case: the client may be one that acknowledges several at a time.
  std::uint32_t room(Time now, std::size_t crowd);

  bool is_measured() const { return is_measured_; }
  // Bytes per second over the last kWindow in which something was on its way. Falls while nothing
  // arrives.
  double rate(Time now) const;
  // A slice is late, or the newer part of that window brought much less than the whole: what rate()
  // will fall to is not known yet.
  bool is_falling(Time now) const;

  // What it may turn out to be: before it is measured, by what little has been seen, so that a
  // client is not left without anything because its connection is not known yet; while it is
  // silent, and until a silence has left the window: as before, as it may come back.
  double hope(Time now) const;

  static constexpr Duration kNudge{0.25};

 private:
  static constexpr Duration kWindow{0.4};
  static constexpr Duration kLeastTime{0.2};  // shorter bursts tell of buffers, not of the link
  static constexpr Duration kSample{0.02};    // samples lie apart by this or more
  static constexpr Duration kSliceTime{0.04};
  static constexpr Duration kSliceCost{50e-6};    // of a processor's time, whatever its length
  static constexpr Duration kQueue{0.1};          // what may queue beyond the link's own delay;
  static constexpr Duration kFastQueue{0.04};     // where the link is fast, this
  static constexpr double kFastExtra = 6 * 1024;  // and so many bytes
  static constexpr Duration kShortQueue{0.03};    // less than this: the link may take more
  static constexpr Duration kBaseAge{10};         // the link's delay is measured anew
  static constexpr std::uint64_t kEnough = 64 * 1024;  // arrived: measured, however fast
  static constexpr std::size_t kMostMarks = 64;
  static constexpr double kFirstWindow = 16 * 1024;
  static constexpr double kLeastWindow = 4 * 1024;
  static constexpr double kMostWindow = 16 << 20;
  // Of all connections: what delays may take that are not known to be their own; and where nothing
  // is known of that, so that visitors who are far away are not held back behind a proxy.
  static constexpr double kShared = 256 * 1024, kUnknownShared = 8 << 20;

  struct Mark {
    std::uint64_t end;  // sent up to here
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
  Time then_{};              // of the last event
  Duration busy_{0};         // with something on its way, up to then_
  Time progress_{};          // when something arrived or was sent
  std::vector<Mark> marks_;  // of what is on its way, in order
  std::vector<Sample> samples_;
  bool is_measured_ = false;
  double steady_ = 0;                // the rate, a silence not counted
  Time heard_{};                     // when something arrived, or was sent after nothing
  Duration recovered_{0};            // the end of the last silence, as busy_
  Duration base_ = Duration::max();  // the shortest way to the client and back
  Time base_since_{};
  bool drains_ = false;  // until nothing is on its way, so that base_ is seen without a queue
  std::optional<Duration> own_;  // of the delay: surely no queue
  double window_ = kFirstWindow;
  Duration slice_time_ = kSliceTime;  // in a crowd it is longer, as slices cost time
};

}  // namespace vitrine
