// SPDX-License-Identifier: Apache-2.0
// Whether the first frames of a scan show an object in the laser's light, and if not, what the
// operator should do.
#pragma once

#include <vector>

#include "acquisition/session/processing.h"

namespace vitrine {

class FirstLook {
 public:
  FirstLook(const Calibration& calibration, const StripeOptions& stripe)
      : calibration_(calibration), options_(stripe) {}

  // Another view, with the table at `angle` degrees.
  Expected<void> add(const FramePair& frames, double angle);

  // Of all views so far.
  Expected<void> judgement() const;

 private:
  const Calibration& calibration_;
  const StripeOptions options_;
  StripeCount stripe_;
  std::vector<Profile> profiles_;
};

}  // namespace vitrine
