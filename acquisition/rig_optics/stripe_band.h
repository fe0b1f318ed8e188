// SPDX-License-Identifier: Apache-2.0
// Finds the pixels that may show laser light, so that rays are cast only for these pixels.
#pragma once

#include <vector>

#include "acquisition/rig_optics/local_optics.h"
#include "acquisition/rig_optics/subject.h"

namespace vitrine::acquisition::rig {

struct PixelRun {
  int first = 0, last = 0;  // inclusive range of pixels in one row
};

// Returns, for each row of the sensor, ascending disjoint runs that contain the stripe. The runs
// leave out parts of the subject farther than `half` mm from the middle of the sheet. They include
// parts hidden from camera or laser.
std::vector<std::vector<PixelRun>> stripe_band(const LocalOptics& optics, const Subject& subject,
                                               double half);

}  // namespace vitrine::acquisition::rig
