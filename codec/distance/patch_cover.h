// SPDX-License-Identifier: Apache-2.0
// Bounds the distance from a triangle T to a surface, using a patch of the surface that lies above
// or below T.
//
// The prism over T is the set of points whose projection to T's plane lies in T. The patch starts
// at one triangle and grows across every edge that reaches into the prism. Suppose that none of
// these edges is a border edge. Count the patch's triangles over a point of T: +1 if they face up,
// -1 if they face down. The sum is then the same at every point of T and is called the degree of
// the patch. If the degree is not 0, part of the patch lies straight above or below every point of
// T. The largest height of the patch over T then bounds the distance.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "codec/distance/witness_surface.h"

namespace vitrine::inline codec {

// Records which triangles of a surface are close to triangles that patches have covered.
struct Overlaps {
  static constexpr std::uint32_t kNone = 0xFFFF'FFFFu;

  // Per triangle of the surface: the mark passed to the last cover() call that found the whole
  // triangle within `limit` of the covered triangle. It is 0 if there was no such call.
  std::vector<std::uint16_t> mark;
  // Per triangle: the number, counted from 1, of the last cover() call whose patch included the
  // triangle. It is 0 if there was no such call.
  std::vector<std::uint32_t> met;
  std::vector<std::uint32_t> calls;  // per call: covered triangle, or kNone if cover() failed

  // Returns a covered triangle near triangle t, or nullopt if none is known.
  std::optional<std::uint32_t> near(std::uint32_t t) const {
    if (met.empty() || met[t] == 0 || calls[met[t] - 1] == kNone) return std::nullopt;
    return calls[met[t] - 1];
  }
};

class PatchCover {
 public:
  explicit PatchCover(const WitnessSurface& surface);

  struct CoverResult {
    // Whether every point of the covered triangle is within `height` of the surface.
    bool is_covered = false;
    // Upper bound of the distance in model units. At most `limit`, up to rounding. Each marked
    // triangle is also within this distance of the covered triangle.
    double height = 0;
  };
  // Tries to cover `triangle` by a patch of the surface. The patch grows from the surface's
  // triangle `start`, which should be near the centre of `triangle`. `number` is the caller's
  // number of `triangle`, for Overlaps::calls. Stores `mark` (not 0) in Overlaps::mark for each
  // surface triangle of the patch that lies completely within `limit` of `triangle`.
  CoverResult cover(const TrianglePoints& triangle, std::uint32_t number, std::uint32_t start,
                    double limit, std::uint16_t mark);

  Overlaps overlaps() && { return {std::move(marks_), std::move(met_), std::move(calls_)}; }

 private:
  using Lanes __attribute__((vector_size(16))) = float;
  struct Prism;
  // A point in the coordinates of the prism.
  struct PrismPoint {
    // Lane 0: height over the triangle's plane, negative below it. Lanes 1 to 3: distance from each
    // wall times the length of the wall, positive inside the prism.
    Lanes at;
    float slack;    // error bound of `at`
    float squared;  // upper bound of the squared distance to the triangle
    unsigned bits;  // bitwise or of kBeyond, kAside and kFar flags

    float height() const { return std::abs(at[0]) + slack; }
  };
  static constexpr unsigned kBeyond = 7;  // bit k: the point is certainly beyond wall k + 1
  // Two bits per wall: the point is certainly farther from the wall than Prism::centre, or
  // certainly closer.
  static constexpr unsigned kAside = 63 << 3;
  static constexpr unsigned kFar = 1 << 9;  // the point is farther from corner a than kFarthest
  // A triangle still to be examined. `edge` is the edge across which the patch reached the
  // triangle. It runs from corner `edge` to the next corner.
  struct OpenTriangle {
    std::uint32_t triangle, edge;
    PrismPoint from, to;
  };
  static float area(const Lanes& a, const Lanes& b, const Lanes& c);
  static float height_inside(const PrismPoint& a, const PrismPoint& b, const PrismPoint& c);
  float height(const Prism& prism, const OpenTriangle& open, const PrismPoint& apex) const;
  bool lay(const Prism& prism, std::uint32_t start);
  bool step(const Prism& prism, const OpenTriangle& open);
  bool count(const PrismPoint& a, const PrismPoint& b, const PrismPoint& c, const Lanes& centre);
  static bool passes_by(const Prism& prism, const PrismPoint& from, const PrismPoint& to);
  bool cross_edge(const Prism& prism, std::uint32_t triangle, std::uint32_t edge,
                  const PrismPoint& from, const PrismPoint& to);

  const WitnessSurface& surface_;
  std::vector<std::uint16_t> marks_;
  std::vector<std::uint32_t> met_, calls_;  // become Overlaps::met and Overlaps::calls
  std::uint16_t mark_ = 0;
  std::uint32_t call_ = 0;
  std::vector<OpenTriangle> open_;
  int degree_ = 0;     // degree of the triangles added so far
  float height_ = 0;   // largest height so far, in units of the prism
  float squared_ = 0;  // largest squared distance of marked triangles, in prism units
};

}  // namespace vitrine::inline codec
