// SPDX-License-Identifier: Apache-2.0
// Where the models of a chunk start. Written by `train-tables` (tests/training), which names the
// meshes; a change is a change of the format. The forms are those that take least room in the
// browser's compressed module.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "codec/core/range_coder.h"

namespace vitrine::trained {

// Numbers as text, such as "-.0386 7.9e-18 ".
extern const char kCutWeights[];         // CutModel::kFeatures
extern const char kTangentialWeights[];  // DisplacementModel::kKinds * kFeatures
extern const char kNormalWeights[];      // DisplacementModel::kKinds * kFeatures
extern const char kEvidence[];           // DisplacementModel::kClues * kLevels * 4: Evidence

// Two numbers a bit: kHalf and eight times the logit of its probability, and an index in kSeen.
extern const std::uint8_t kFlagBits[];      // FlagModel::kBits
extern const std::uint8_t kCutBits[];       // CutModel::kBits
extern const std::uint8_t kResidualBits[];  // ResidualCoder::kBits

inline constexpr std::size_t kHalf = 64;
inline constexpr std::array<std::uint8_t, 14> kSeen = {0,  1,  2,  3,  4,  6,  8,
                                                       11, 16, 23, 32, 45, 64, 90};

void load(const char* text, std::span<double> numbers);
void load(const std::uint8_t* packed, std::span<AdaptiveBit> bits);

template <std::size_t kCount>
std::array<double, kCount> numbers_of(const char* text) {
  std::array<double, kCount> numbers;
  load(text, numbers);
  return numbers;
}

}  // namespace vitrine::trained
