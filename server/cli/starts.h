// SPDX-License-Identifier: Apache-2.0
// Where an operator says that several scans of one object lie.
#pragma once

#include <string>
#include <vector>

#include "codec/core/expected.h"
#include "codec/mesh/rigid_alignment.h"

namespace vitrine::cli {

// {"starts": [{"axis": {"x": 1}, "degrees": 180, "shift": {"z": 80}}]}: of the second scan and of
// each after it the motion that brings it about onto the first. It is turned about the axis through
// the origin, counter-clockwise for who looks from its tip, and then shifted, in mm; what is left
// out is 0. Fails (kIo, kBadInput) with file, key and what is expected there. The result begins
// with the first scan's motion, which is none.
Expected<std::vector<RigidMotion>> read_starts(const std::string& path);
Expected<std::vector<RigidMotion>> parse_starts(std::string_view text, const std::string& place);

}  // namespace vitrine::cli
