// SPDX-License-Identifier: Apache-2.0
// The calibration target, a ChArUco board [ChArUco]: a chessboard with a marker in each white
// square.
#pragma once

#include <string>
#include <vector>

#include "acquisition/frame/frame.h"
#include "codec/core/expected.h"

namespace vitrine::acquisition {

struct CharucoTarget {
  int squares_x = 0, squares_y = 0;
  double square_mm = 0, marker_mm = 0;  // edge lengths of a square and of a marker
  std::string dictionary;               // OpenCV's name of the dictionary, such as DICT_4X4_50
};

struct TargetPoint {
  double x = 0, y = 0;  // mm from one corner of the target, along its edges
};

// The inner corners found in a picture. `ids` are the corners' numbers on the target, counted row
// by row from 0.
struct TargetView {
  std::vector<int> ids;
  std::vector<ImagePoint> corners;
};

// Checks the dimensions of a target. Fails with kBadInput if they are impossible; the error says
// which value is wrong.
Expected<void> check_target(const CharucoTarget& target);

// Returns the position of an inner corner on the target.
TargetPoint corner_on(const CharucoTarget& target, int id);

// Finds the target's corners, at sub-pixel precision, in a picture taken without laser. Fails with
// kBadInput if the picture does not show enough of the target to determine its pose; the error says
// what to change.
Expected<TargetView> find_target(const Frame& frame, const CharucoTarget& target);

}  // namespace vitrine::acquisition
