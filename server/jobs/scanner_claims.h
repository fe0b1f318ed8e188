// SPDX-License-Identifier: Apache-2.0
// Which scanners are this daemon's: of all daemons that are configured for one, one at a time
// drives it, in an epoch that ends where its lease is not renewed. Who was stopped beyond that, or
// cannot reach the catalogue, commands no device.
#pragma once

#include <chrono>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "server/catalogue/jobs.h"
#include "server/jobs/heart.h"
#include "server/log/log.h"

namespace vitrine {

// Thread-safe.
class ScannerClaims {
 public:
  // `address`: ScannerDriver::address. The catalogue outlives it.
  ScannerClaims(JobCatalogue& catalogue, Log events, Lease lease, std::string address);
  // Takes those of `names`, which are configured here, that are free. From then on there is a
  // beat() every two seconds.
  void start(std::vector<std::string> names);
  // Renews what is held, and takes what has become free.
  void beat();
  // Nothing is renewed or taken any more.
  void stop() { heart_.reset(); }

  // Whether the scanner may be commanded now: kIo where not, with who may or why.
  Expected<void> check(const std::string& scanner) const;
  // Whether its jobs are this daemon's: it drives the scanner, or nobody ever did but itself.
  bool has_jobs_of(const std::string& scanner) const;
  // Where the daemon is that drives it; empty where it did last and has let its lease run out.
  // Nothing where that is this one, or nobody, or where it is not to be reached.
  std::optional<std::string> address_of(const std::string& scanner) const;
  // The others that are there, by their addresses, and which scanners they drive.
  std::map<std::string, std::vector<std::string>> others() const;

 private:
  using Clock = std::chrono::nanoseconds;  // since the machine has started, suspended or not
  struct Held {
    std::uint64_t epoch = 0;
    Clock until{};  // by this machine's clock, a little before the catalogue thinks so
  };
  static Clock now();
  bool may_take(const std::string& scanner) const;
  void take(const std::string& scanner);
  void renew(const std::string& scanner, const Held& held);
  void look_at_others();
  bool is_elsewhere(const ScannerDriver& driver) const;

  JobCatalogue& catalogue_;
  const Log events_;
  const Lease lease_;
  const std::string address_;

  mutable std::mutex mutex_;  // guards what follows
  std::vector<std::string> names_;
  std::map<std::string, Held> held_;
  std::vector<ScannerDriver> drivers_;  // as last seen
  // When others' leases that have run out are believed: while the catalogue is away nobody can
  // renew one.
  Clock believes_from_{};

  std::optional<Heart> heart_;
};

}  // namespace vitrine
