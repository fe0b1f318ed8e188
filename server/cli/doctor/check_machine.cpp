// SPDX-License-Identifier: Apache-2.0
#include "server/cli/doctor/checks.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/timex.h>

namespace vitrine::server {
namespace {

// The number of open files that the daemon needs: the default of max-connections, and 512 for the
// daemon itself.
constexpr rlim_t kOpenFiles = 10'512;

// Checks the clock, since tokens, jobs and certificates depend on it.
Finding check_clock() {
  timex state{};  // with modes = 0, adjtimex() only reads the state
  if (::adjtimex(&state) < 0)
    return {Verdict::kWarn, "clock", "the system does not report its state",
            "ask the administrator of the host"};
  if ((state.status & STA_UNSYNC) == 0) return {Verdict::kOk, "clock", "synchronised", ""};
  return {Verdict::kWarn, "clock", "not synchronised",
          "enable systemd-timesyncd or chrony; in a container, on its host"};
}

Finding check_open_files() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) limit.rlim_max = 0;
  const bool endless = limit.rlim_max == RLIM_INFINITY;
  const std::string detail = endless ? "no limit" : fmt::format("{} at most", limit.rlim_max);
  if (endless || limit.rlim_max >= kOpenFiles) return {Verdict::kOk, "open files", detail, ""};
  return {Verdict::kWarn, "open files", detail,
          fmt::format("raise the limit to {} (systemd: LimitNOFILE) for 10,000 connections",
                      kOpenFiles)};
}

}  // namespace

Findings check_machine() {
  return {check_clock(), check_open_files()};
}

}  // namespace vitrine::server
