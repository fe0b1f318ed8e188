// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/scanner_claims.h"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <utility>

namespace vitrine::server {
namespace {

constexpr std::chrono::seconds kScannerBeat{2};
// By this daemon's clock, a lease ends this much earlier than in the catalogue.
constexpr std::chrono::seconds kMargin{1};

}  // namespace

ScannerClaims::ScannerClaims(JobCatalogue& catalogue, Log events, Lease lease, std::string address)
    : catalogue_(catalogue),
      events_(std::move(events)),
      lease_(std::move(lease)),
      address_(std::move(address)) {}

ScannerClaims::Clock ScannerClaims::now() {
  timespec time{};
  ::clock_gettime(CLOCK_BOOTTIME, &time);
  return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

void ScannerClaims::start(std::vector<std::string> names) {
  {
    const std::scoped_lock lock(mutex_);
    names_ = std::move(names);
  }
  beat();
  lease_renewal_.emplace(kScannerBeat, events_, [this] { beat(); });
}

void ScannerClaims::beat() {
  std::vector<std::string> names;
  {
    const std::scoped_lock lock(mutex_);
    names = names_;
  }
  for (const std::string& name : names) {
    std::optional<HeldScanner> held;
    {
      const std::scoped_lock lock(mutex_);
      if (const auto found = held_.find(name); found != held_.end()) held = found->second;
    }
    if (held) {
      renew(name, *held);
    } else if (may_take(name)) {
      take(name);
    }
  }
  look_at_others();
}

// Whether this daemon may try to acquire the scanner. After the catalogue was unreachable, returns
// false for the duration of one lease, so that the daemon that drives the scanner can renew its
// lease first.
bool ScannerClaims::may_take(const std::string& scanner) const {
  const std::scoped_lock lock(mutex_);
  const auto driver = std::ranges::find(drivers_, scanner, &ScannerDriver::scanner);
  const bool is_anothers = driver != drivers_.end() && driver->holder != lease_.holder;
  return !is_anothers || now() >= believes_from_;
}

// Acquires the scanner. Computes the end of the lease from a time before the request to the
// catalogue, so that this daemon never assumes too late an end.
void ScannerClaims::take(const std::string& scanner) {
  const Clock until = now() + lease_.time - kMargin;
  const auto epoch = catalogue_.take_scanner(scanner, lease_, address_);
  if (!epoch || !*epoch) return;
  events_.event(Severity::kInfo, fmt::format("drives scanner {} in epoch {}", scanner, **epoch));
  const std::scoped_lock lock(mutex_);
  held_[scanner] = {**epoch, until};
}

void ScannerClaims::renew(const std::string& scanner, const HeldScanner& held) {
  const Clock until = now() + lease_.time - kMargin;
  const auto renewed = catalogue_.renew_scanner(scanner, held.epoch, lease_.time);
  if (!renewed) events_.event(Severity::kWarning, renewed.error().message);
  const std::scoped_lock lock(mutex_);
  if (renewed) held_[scanner].until = until;
  if (!renewed && renewed.error().code == ErrorCode::kState) held_.erase(scanner);
}

void ScannerClaims::look_at_others() {
  auto drivers = catalogue_.scanner_drivers();
  const std::scoped_lock lock(mutex_);
  if (drivers) {
    drivers_ = std::move(*drivers);
  } else {
    believes_from_ = now() + lease_.time;
  }
}

Expected<void> ScannerClaims::check(const std::string& scanner) const {
  const std::scoped_lock lock(mutex_);
  const auto held = held_.find(scanner);
  if (held != held_.end() && now() < held->second.until) return {};
  return fail(ErrorCode::kIo,
              held == held_.end()
                  ? fmt::format("another daemon drives scanner {}; stop one of them", scanner)
                  : fmt::format("the catalogue is unreachable, so scanner {} is paused; check it",
                                scanner));
}

bool ScannerClaims::has_jobs_of(const std::string& scanner) const {
  const std::scoped_lock lock(mutex_);
  if (held_.contains(scanner)) return true;
  if (std::ranges::find(names_, scanner) != names_.end()) return false;
  const auto driver = std::ranges::find(drivers_, scanner, &ScannerDriver::scanner);
  return driver == drivers_.end() || driver->holder == lease_.holder;
}

std::optional<std::string> ScannerClaims::address_of(const std::string& scanner) const {
  const std::scoped_lock lock(mutex_);
  const auto driver = std::ranges::find(drivers_, scanner, &ScannerDriver::scanner);
  if (driver == drivers_.end() || held_.contains(scanner) || !is_another_daemon(*driver))
    return std::nullopt;
  return driver->is_current ? driver->address : "";
}

std::map<std::string, std::vector<std::string>> ScannerClaims::others() const {
  const std::scoped_lock lock(mutex_);
  std::map<std::string, std::vector<std::string>> all;
  for (const ScannerDriver& driver : drivers_) {
    if (is_another_daemon(driver) && driver.is_current)
      all[driver.address].push_back(driver.scanner);
  }
  return all;
}

bool ScannerClaims::is_another_daemon(const ScannerDriver& driver) const {
  return driver.holder != lease_.holder && !driver.address.empty();
}

}  // namespace vitrine::server
