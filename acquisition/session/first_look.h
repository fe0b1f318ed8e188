// SPDX-License-Identifier: Apache-2.0
// Checks whether the first frames of a scan show an object in the laser's light. If not, the error
// says what the operator should do.
#pragma once

#include <vector>

#include "acquisition/session/processing.h"

namespace vitrine::acquisition {

class FirstLook {
 public:
  FirstLook(const Calibration& calibration, const StripeOptions& stripe)
      : calibration_(calibration), options_(stripe) {}

  // Adds the frames taken with the table at `angle` degrees.
  Expected<void> add(const FramePair& frames, double angle);

  // Judges all frames added so far.
  Expected<void> judgement() const;

 private:
  const Calibration& calibration_;
  const StripeOptions options_;
  StripeCount stripe_;
  std::vector<Profile> profiles_;
};

}  // namespace vitrine::acquisition
