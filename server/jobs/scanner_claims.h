// SPDX-License-Identifier: Apache-2.0
// Which scanners are this daemon's: of all daemons that are configured for one, one at a time
// drives it, in an epoch that ends where its lease is not renewed. Who was stopped beyond that, or
// cannot reach the catalogue, commands no device.
#pragma once

#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "server/catalogue/jobs.h"
#include "server/log/log.h"

namespace vitrine {

// Thread-safe.
class ScannerClaims {
 public:
  // `address`: ScannerDriver::address. The catalogue outlives it.
  ScannerClaims(JobCatalogue& catalogue, Log events, Lease lease, std::string address);
  ~ScannerClaims() { heart_ = {}; }
  ScannerClaims(const ScannerClaims&) = delete;
  ScannerClaims& operator=(const ScannerClaims&) = delete;

  // Takes those of `names`, which are configured here, that are free. From then on there is a
  // beat() every two seconds.
  void start(std::vector<std::string> names);
  // Renews what is held, and takes what has become free.
  void beat();

  // Whether the scanner may be commanded now: kIo where not, with who may or why.
  Expected<void> check(const std::string& scanner) const;
  // Whether its jobs are this daemon's: it drives the scanner, or nobody ever did but itself.
  bool has_jobs_of(const std::string& scanner) const;
  // Where the daemon is that drives it; nothing where that is this one, or nobody.
  std::optional<std::string> address_of(const std::string& scanner) const;
  std::vector<std::string> addresses() const;  // of all others, each once

 private:
  using Clock = std::chrono::nanoseconds;  // since the machine has started, suspended or not
  struct Held {
    std::uint64_t epoch = 0;
    Clock until{};  // by this machine's clock, a little before the catalogue thinks so
  };
  static Clock now();
  void take(const std::string& scanner);
  void renew(const std::string& scanner, const Held& held);
  void look_at_others();

  JobCatalogue& catalogue_;
  const Log events_;
  const Lease lease_;
  const std::string address_;

  mutable std::mutex mutex_;  // guards what follows
  std::vector<std::string> names_;
  std::map<std::string, Held> held_;
  std::vector<ScannerDriver> drivers_;  // as last seen

  std::mutex resting_;
  std::condition_variable_any rest_;
  std::jthread heart_;
};

}  // namespace vitrine
