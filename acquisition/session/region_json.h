// SPDX-License-Identifier: Apache-2.0
// Reads and writes the region of the sensor, as in rig.json and scan.json.
#pragma once

#include "acquisition/frame/frame.h"
#include "acquisition/session/json_members.h"

namespace vitrine::acquisition {

inline SensorRegion region_in(JsonMembers& root) {
  constexpr int kMost = 1 << 15;  // limit of each value, in pixels
  auto members = root.object("region", {"x", "y", "width", "height"});
  const SensorRegion region{.x = members.whole("x", 0, kMost, 0),
                            .y = members.whole("y", 0, kMost, 0),
                            .width = members.whole("width", 0, kMost, 0),
                            .height = members.whole("height", 0, kMost, 0)};
  root.adopt(members);
  return region;
}

inline nlohmann::json to_json(const SensorRegion& region) {
  return {{"x", region.x}, {"y", region.y}, {"width", region.width}, {"height", region.height}};
}

}  // namespace vitrine::acquisition
