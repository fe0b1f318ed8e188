// SPDX-License-Identifier: Apache-2.0
// Chance that can be repeated: numbers that are a function of a key and an index alone.
#pragma once

#include <cstdint>

namespace vitrine::rig {

// 64 bits that look random (splitmix64).
constexpr std::uint64_t scramble(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31);
}

// One key for several parts; their order matters.
constexpr std::uint64_t key_of(std::uint64_t a, std::uint64_t b, std::uint64_t c = 0) {
  return scramble(scramble(scramble(a) ^ b) ^ c);
}

// In [-1, 1).
constexpr double uniform(std::uint64_t key) {
  return static_cast<double>(scramble(key) >> 11) * 0x1p-52 - 1;
}

// Normally distributed, mean 0, variance 1, up to 3.7 from the mean.
float normal(std::uint64_t key, std::uint64_t index);

// The same for ascending indices, faster: four neighbours share 64 bits.
class NormalSequence {
 public:
  NormalSequence(std::uint64_t key, std::uint64_t first);
  float next();

 private:
  std::uint64_t key_, index_, bits_;
};

}  // namespace vitrine::rig
