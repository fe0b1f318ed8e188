// SPDX-License-Identifier: Apache-2.0
// A calibration as JSON. Numbers keep every bit; what is read is checked against bounds.
#pragma once

#include <string>
#include <string_view>

#include "acquisition/calibration/calibration.h"
#include "codec/core/expected.h"

namespace vitrine {

std::string to_json(const Calibration& calibration);

// `name` is what errors (kBadInput) call it by; they tell what is wrong with which key.
Expected<Calibration> calibration_from_json(std::string_view text, const std::string& name);

// {"a": …, "b": …, "offset": …, "tilt": …, "clockwise": false}, as in a calibration; people write
// it, so that what else it holds is a fault.
Expected<Axis> axis_from_json(std::string_view text, const std::string& name);

}  // namespace vitrine
