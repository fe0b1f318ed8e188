// SPDX-License-Identifier: Apache-2.0
// Reads and writes a calibration as JSON. Numbers are written with enough digits to restore every
// bit. When read, they are checked against bounds.
#pragma once

#include <string>
#include <string_view>

#include "acquisition/calibration/calibration.h"
#include "codec/core/expected.h"

namespace vitrine::acquisition {

std::string to_json(const Calibration& calibration);

// Parses a calibration. Errors (kBadInput) call the document `name` and state the faulty key.
Expected<Calibration> calibration_from_json(std::string_view text, const std::string& name);

// Parses {"a": …, "b": …, "offset": …, "tilt": …, "clockwise": false}, as in a calibration. People
// write this object by hand, so unknown keys are errors.
Expected<TurntableAxis> axis_from_json(std::string_view text, const std::string& name);

}  // namespace vitrine::acquisition
