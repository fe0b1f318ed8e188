// SPDX-License-Identifier: Apache-2.0
// Reads the approximate poses of several scans of one object.
#pragma once

#include <string>
#include <vector>

#include "codec/core/expected.h"
#include "codec/distance/rigid_alignment.h"

namespace vitrine::server::cli {

// Reads a file such as {"starts": [{"axis": {"x": 1}, "degrees": 180, "shift": {"z": 80}}]}. Each
// entry is for one scan, from the second on. It is the motion that moves the scan approximately
// onto the first scan: a rotation about the axis through the origin, counter-clockwise when seen
// from the axis's tip, and then a shift in mm. Missing values are 0. The result begins with the
// identity for the first scan. Errors (kIo or kBadInput) name the file, the key and what is
// expected there.
Expected<std::vector<RigidMotion>> read_starts(const std::string& path);
Expected<std::vector<RigidMotion>> parse_starts(std::string_view text, const std::string& place);

}  // namespace vitrine::server::cli
