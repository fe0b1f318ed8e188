// SPDX-License-Identifier: Apache-2.0
// Where the models of a chunk start. Written by `train-tables` (tests/training), which names the
// meshes; a change is a change of the format.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "codec/core/range_coder.h"

namespace vitrine::trained {

extern const double kCutWeights[];           // CutModel::kFeatures
extern const double kTangentialWeights[];    // DisplacementModel::kKinds * kFeatures
extern const double kNormalWeights[];        // DisplacementModel::kKinds * kFeatures
extern const double kEvidence[];             // DisplacementModel::kClues * kLevels * 4: Evidence
extern const std::uint16_t kFlagBits[];      // FlagModel::kBits, AdaptiveBit::from_packed
extern const std::uint16_t kCutBits[];       // CutModel::kBits
extern const std::uint16_t kResidualBits[];  // ResidualCoder::kBits

template <std::size_t kCount>
void load(const std::uint16_t* packed, std::array<AdaptiveBit, kCount>& bits) {
  for (std::size_t k = 0; k < kCount; ++k)
    bits[k] = AdaptiveBit::from_packed(packed[k]);
}

}  // namespace vitrine::trained
