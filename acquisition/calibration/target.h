// SPDX-License-Identifier: Apache-2.0
// The calibration target: a ChArUco board, a chessboard whose white squares hold markers.
#pragma once

#include <string>
#include <vector>

#include "acquisition/frame/frame.h"
#include "codec/core/expected.h"

namespace vitrine {

struct Target {
  int squares_x = 0, squares_y = 0;
  double square_mm = 0, marker_mm = 0;  // edges
  std::string dictionary;               // by OpenCV's names: DICT_4X4_50, …
};

struct Pixel {
  double u = 0, v = 0;
};

// The inner corners that were found; ids are theirs on the target, row after row from 0.
struct TargetView {
  std::vector<int> ids;
  std::vector<Pixel> corners;
};

// Whether such a target exists; the error says what is wrong with it.
Expected<void> check_target(const Target& target);

// Where a corner is on the target: mm from a corner of the board along its edges.
Pixel corner_on(const Target& target, int id);

// Sub-pixel corners of the target in a picture without laser. Fails (kBadInput) where there is none
// or too little of it to tell its pose, saying what to change.
Expected<TargetView> find_target(const Frame& frame, const Target& target);

}  // namespace vitrine
