// SPDX-License-Identifier: Apache-2.0
// Which pixels can show laser light at all, so that rays are cast through these alone.
#pragma once

#include <vector>

#include "acquisition/rig/subject.h"
#include "acquisition/rig/view.h"

namespace vitrine::rig {

struct Run {
  int first = 0, last = 0;  // pixels of a row, both within
};

// For each row of the sensor, ascending and apart. Parts of the subject farther than `half` mm from
// the middle of the sheet do not count; what something hides from camera or laser does.
std::vector<std::vector<Run>> stripe_band(const View& view, const Subject& subject, double half);

}  // namespace vitrine::rig
