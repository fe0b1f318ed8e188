// SPDX-License-Identifier: Apache-2.0
// Repeatable random numbers, as functions of a key and an index.
#pragma once

#include <cstdint>

namespace vitrine::acquisition::rig {

// Hashes a number to 64 random-looking bits ([SLF14], splitmix64).
constexpr std::uint64_t scramble(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31);
}

// Combines several numbers into one key, which depends on their order.
constexpr std::uint64_t key_of(std::uint64_t a, std::uint64_t b, std::uint64_t c = 0) {
  return scramble(scramble(scramble(a) ^ b) ^ c);
}

// Returns a number that is uniformly distributed in [-1, 1).
constexpr double uniform(std::uint64_t key) {
  return static_cast<double>(scramble(key) >> 11) * 0x1p-52 - 1;
}

// Returns a number that is normally distributed with mean 0 and variance 1, truncated at 3.7.
float normal(std::uint64_t key, std::uint64_t index);

// Returns the values of normal() for ascending indices. This class is faster than normal(), because
// four neighbours share 64 random bits.
class NormalSequence {
 public:
  NormalSequence(std::uint64_t key, std::uint64_t first);
  float next();

 private:
  std::uint64_t key_, index_, bits_;
};

}  // namespace vitrine::acquisition::rig
