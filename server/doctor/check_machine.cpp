// SPDX-License-Identifier: Apache-2.0
#include "server/doctor/check_machine.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/timex.h>

namespace vitrine {
namespace {

constexpr rlim_t kOpenFiles = 10'512;  // the default of max-connections and 512 of the daemon's own

// Tokens, jobs and certificates are dated by it.
Finding check_clock() {
  timex state{};  // asks, and changes nothing
  if (::adjtimex(&state) < 0)
    return {Verdict::kWarn, "clock", "its state is not told", "ask the administrator of the host"};
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

}  // namespace vitrine
