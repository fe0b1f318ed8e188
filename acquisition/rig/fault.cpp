// SPDX-License-Identifier: Apache-2.0
#include "acquisition/rig/fault.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace vitrine::acquisition::rig {
namespace {

struct Name {
  std::string_view name;
  FaultKind kind;
  int step;  // default of RigFault::step
};

constexpr Name kFaults[] = {{"lost-packets", FaultKind::kLostPackets, 0},
                            {"camera-unplug", FaultKind::kCameraUnplug, 1},
                            {"usb-unplug", FaultKind::kUsbUnplug, 1},
                            {"motor-stall", FaultKind::kMotorStall, 1},
                            {"missed-trigger", FaultKind::kMissedTrigger, 1},
                            {"drift", FaultKind::kDrift, 0},
                            {"laser-out", FaultKind::kLaserOut, 0},
                            {"second-stripe", FaultKind::kSecondStripe, 0}};

Unexpected unknown(std::string_view text) {
  std::string names;
  for (const Name& known : kFaults)
    names += fmt::format("{}{}", names.empty() ? "" : ", ", known.name);
  return fail(
      ErrorCode::kBadInput,
      fmt::format("fault {}: not known; give NAME or NAME@STEP with one of {}", text, names));
}

}  // namespace

Expected<RigFault> parse_fault(std::string_view text) {
  const std::size_t at = text.find('@');
  const auto known = std::find_if(std::begin(kFaults), std::end(kFaults), [&](const Name& name) {
    return name.name == text.substr(0, at);
  });
  if (known == std::end(kFaults)) return unknown(text);
  RigFault fault{known->kind, known->step};
  if (at == std::string_view::npos) return fault;
  const char *first = text.data() + at + 1, *last = text.data() + text.size();
  const auto [end, error] = std::from_chars(first, last, fault.step);
  if (error != std::errc() || end != last || fault.step < 0) return unknown(text);
  return fault;
}

bool due(const std::vector<RigFault>& faults, FaultKind kind, int turns) {
  return std::any_of(faults.begin(), faults.end(), [&](const RigFault& fault) {
    return fault.kind == kind && fault.step == turns;
  });
}

bool lasting(const std::vector<RigFault>& faults, FaultKind kind, int turns) {
  return std::any_of(faults.begin(), faults.end(), [&](const RigFault& fault) {
    return fault.kind == kind && fault.step <= turns;
  });
}

double crept(const std::vector<RigFault>& faults, int turns) {
  double mm = 0;
  for (const RigFault& fault : faults) {
    if (fault.kind == FaultKind::kDrift) mm += kCreepMm * std::max(0, turns - fault.step);
  }
  return mm;
}

}  // namespace vitrine::acquisition::rig
