// SPDX-License-Identifier: Apache-2.0
#include "acquisition/profile/stripe_steps.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vitrine::acquisition {
namespace {

constexpr int kShortestLine = 5;  // shortest line that counts as a second surface, in rows
constexpr int kMostSlant = 10;    // largest shift of a line between adjacent rows, in pixels
// Largest strength in the dark gap between two surfaces, as a share of the weaker peak's strength.
constexpr double kMostLit = .1;

// For each of a row's two peaks, the length in rows of the line that ends at this peak.
using Lengths = std::array<int, 2>;

// Returns whether the two peaks of a row come from two surfaces, with a dark gap between them. A
// stripe parallel to the rows varies in brightness but has no dark gap.
bool are_two_surfaces(const RowPeaks& row) {
  return row.count == 2 && row.valley <= kMostLit * row.peaks[1].strength;
}

// Returns the length of the line that ends at `peak`. This line comes from the adjacent row
// `before`, where it continues the line of the nearest peak.
int length_at(const Peak& peak, const RowPeaks& before, const Lengths& lengths) {
  int nearest = kMostSlant + 1, length = 1;
  for (std::size_t k = 0; k < static_cast<std::size_t>(before.count); ++k) {
    const int jump = std::abs(before.peaks[k].u - peak.u);
    if (jump < nearest) nearest = jump, length = lengths[k] + 1;
  }
  return length;
}

Lengths lengths_of(const RowPeaks& row, const RowPeaks& before, const Lengths& lengths) {
  return {length_at(row.peaks[0], before, lengths), length_at(row.peaks[1], before, lengths)};
}

}  // namespace

std::vector<int> second_peaks(std::span<const RowPeaks> rows, std::span<const int> chosen) {
  std::vector<Lengths> from_above(rows.size(), {1, 1});
  for (std::size_t v = 1; v < rows.size(); ++v)
    from_above[v] = lengths_of(rows[v], rows[v - 1], from_above[v - 1]);
  std::vector<int> second(rows.size(), -1);
  Lengths from_below{1, 1};
  for (std::size_t v = rows.size(); v-- > 0;) {
    from_below = v + 1 < rows.size() ? lengths_of(rows[v], rows[v + 1], from_below) : Lengths{1, 1};
    if (!are_two_surfaces(rows[v])) continue;
    const int other = 1 - chosen[v];
    const auto k = static_cast<std::size_t>(other);
    if (from_above[v][k] + from_below[k] > kShortestLine) second[v] = other;
  }
  return second;
}

}  // namespace vitrine::acquisition
