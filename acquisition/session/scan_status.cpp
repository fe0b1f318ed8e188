// SPDX-License-Identifier: Apache-2.0
#include "acquisition/session/scan_status.h"

#include <algorithm>
#include <array>

namespace vitrine::acquisition {
namespace {

constexpr std::array<std::string_view, 8> kNames = {"idle",    "checking", "scanning",  "paused",
                                                    "meshing", "done",     "cancelled", "failed"};

}  // namespace

std::string_view name_of(ScanState state) {
  return kNames[static_cast<std::size_t>(state)];
}

std::optional<ScanState> state_of(std::string_view name) {
  const auto it = std::find(kNames.begin(), kNames.end(), name);
  if (it == kNames.end()) return std::nullopt;
  return static_cast<ScanState>(it - kNames.begin());
}

}  // namespace vitrine::acquisition
