// SPDX-License-Identifier: Apache-2.0
// The trained initial values of the probability models and predictors. Changing them changes the
// file format. tests/training/train_tables.cpp generates them and lists the training meshes.
// Numbers are stored as text because this takes the least space in the browser's compressed module.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "codec/core/range_coder.h"

namespace vitrine::inline codec::trained {

// Numbers as text, separated by spaces, such as "-.0386 7.9e-18 ".
extern const char kCutWeights[];         // CutModel::kFeatures numbers
extern const char kTangentialWeights[];  // DisplacementModel::kKinds * kFeatures numbers
extern const char kNormalWeights[];      // DisplacementModel::kKinds * kFeatures numbers
// Four numbers for each of the DisplacementModel::kClues * kLevels Evidence structs.
extern const char kEvidence[];

// Two numbers per bit. The first is kHalf plus eight times the logit of the bit's probability. The
// second is an index into kSeen.
extern const std::uint8_t kFlagBits[];      // 2 * FlagModel::kBits numbers
extern const std::uint8_t kCutBits[];       // 2 * CutModel::kBits numbers
extern const std::uint8_t kResidualBits[];  // 2 * ResidualCoder::kBits numbers

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

}  // namespace vitrine::inline codec::trained
