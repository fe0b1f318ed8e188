// SPDX-License-Identifier: Apache-2.0
// The scanners that this daemon drives. Several daemons may be configured for a scanner, but only
// one at a time drives it. That daemon holds a lease on the scanner; each acquisition begins a new
// epoch. A daemon that was suspended for longer than its lease, or that cannot reach the catalogue,
// sends no command to a device.
#pragma once

#include <chrono>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "server/catalogue/jobs.h"
#include "server/jobs/periodic_task.h"
#include "server/log/log.h"

namespace vitrine::server {

// Thread-safe.
class ScannerClaims {
 public:
  // `address` must be in the form of ScannerDriver::address. The catalogue must outlive this
  // object.
  ScannerClaims(JobCatalogue& catalogue, Log events, Lease lease, std::string address);
  // Acquires the scanners in `names` that no other daemon drives. `names` are all scanners
  // configured in this daemon. Then runs beat() every two seconds.
  void start(std::vector<std::string> names);
  // Renews the leases on the held scanners and acquires scanners that have become free.
  void beat();
  // Stops renewing leases and acquiring scanners.
  void stop() { lease_renewal_.reset(); }

  // Succeeds if this daemon may command the scanner now. Otherwise returns kIo with the reason.
  Expected<void> check(const std::string& scanner) const;
  // Whether this daemon runs the scanner's jobs. Returns true if the daemon drives the scanner.
  // Also returns true for a scanner that is not configured here, unless another daemon drove it
  // last.
  bool has_jobs_of(const std::string& scanner) const;
  // Returns the address of the other daemon that drives the scanner, or an empty text if that
  // daemon's lease has expired. Returns nullopt if this daemon or no daemon drives the scanner, or
  // if the other daemon has no address.
  std::optional<std::string> address_of(const std::string& scanner) const;
  // Returns the addresses of the other running daemons, each with the scanners that it drives.
  std::map<std::string, std::vector<std::string>> others() const;

 private:
  // time since the machine was started, including time in suspension
  using Clock = std::chrono::nanoseconds;
  struct HeldScanner {
    std::uint64_t epoch = 0;
    Clock until{};  // end of the lease by this machine's clock, minus a margin
  };
  static Clock now();
  bool may_take(const std::string& scanner) const;
  void take(const std::string& scanner);
  void renew(const std::string& scanner, const HeldScanner& held);
  void look_at_others();
  bool is_another_daemon(const ScannerDriver& driver) const;

  JobCatalogue& catalogue_;
  const Log events_;
  const Lease lease_;
  const std::string address_;

  mutable std::mutex mutex_;  // guards the members up to believes_from_
  std::vector<std::string> names_;
  std::map<std::string, HeldScanner> held_;
  std::vector<ScannerDriver> drivers_;  // drivers as last read from the catalogue
  // Until this time, expired leases of other daemons still count as valid, because these daemons
  // could not renew them while the catalogue was unreachable.
  Clock believes_from_{};

  std::optional<PeriodicTask> lease_renewal_;
};

}  // namespace vitrine::server
