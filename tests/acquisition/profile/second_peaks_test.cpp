// SPDX-License-Identifier: Apache-2.0
#include "acquisition/profile/stripe_steps.h"

#include <gmock/gmock.h>

namespace vitrine::acquisition {
namespace {

using testing::Each;
using testing::ElementsAre;

RowPeaks row_of(Peak strong, Peak weak, int valley = 0) {
  return {2, {strong, weak}, valley};
}

// Returns rows with two peaks each: one in column 100, and a weaker one in column `u(row)`.
template <class Course>
std::vector<RowPeaks> two_surfaces(int rows, Course u) {
  std::vector<RowPeaks> peaks;
  for (int row = 0; row < rows; ++row)
    peaks.push_back(row_of({100, 90}, {u(row), 60}));
  return peaks;
}

TEST(SecondPeaks, TheOtherPeakOfALineIsOne) {
  const auto rows = two_surfaces(5, [](int row) { return 200 + 9 * row; });
  EXPECT_THAT(second_peaks(rows, std::vector(5, 0)), Each(1));
  EXPECT_THAT(second_peaks(rows, std::vector(5, 1)), Each(0));
}

TEST(SecondPeaks, ALineOfFewerRowsIsNone) {
  const auto rows = two_surfaces(4, [](int) { return 200; });
  EXPECT_THAT(second_peaks(rows, std::vector(4, 0)), Each(-1));
}

TEST(SecondPeaks, PeaksThatJumpAreNoLine) {
  const auto rows = two_surfaces(20, [](int row) { return 200 + 11 * (row % 2); });
  EXPECT_THAT(second_peaks(rows, std::vector(20, 0)), Each(-1));
}

// The stripe is peak 0 in the first three rows, and peak 1 in the last three. In each row, the
// other peak belongs to the second surface.
TEST(SecondPeaks, ALineGoesOnWhereItIsChosen) {
  const auto rows = two_surfaces(6, [](int) { return 200; });
  EXPECT_THAT(second_peaks(rows, std::vector{0, 0, 0, 1, 1, 1}), ElementsAre(1, 1, 1, 0, 0, 0));
}

TEST(SecondPeaks, WhereItIsNotDarkBetweenThereIsNone) {
  auto rows = two_surfaces(6, [](int) { return 200; });
  rows[2].valley = 7;
  EXPECT_THAT(second_peaks(rows, std::vector(6, 0)), ElementsAre(1, 1, -1, 1, 1, 1));
}

TEST(SecondPeaks, RowsWithFewerPeaksHaveNone) {
  std::vector<RowPeaks> rows(12);
  for (std::size_t v = 2; v < 10; ++v)
    rows[v] = {1, {{{100, 90}}}};
  std::vector<int> chosen(12, 0);
  chosen[0] = chosen[1] = chosen[10] = chosen[11] = -1;
  EXPECT_THAT(second_peaks(rows, chosen), Each(-1));
  EXPECT_TRUE(second_peaks({}, {}).empty());
}

}  // namespace
}  // namespace vitrine::acquisition
