// SPDX-License-Identifier: Apache-2.0
// Bounds the distance from a triangle T to a surface by a patch of the surface that lies above or
// below T.
//
// The prism over T is the set of points whose projection to T's plane lies in T. The patch starts
// at one triangle and grows across every edge that reaches into the prism. If none of these edges
// is a border edge, the projection of the patch to T has a degree. That is: count the triangles
// over a point of T as +1 if they face up and as -1 if they face down; the sum is the same at every
// point. If the degree is not 0, every point of T has a point of the patch straight above or below
// it. The height of the patch over T then bounds the distance.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "codec/distance/witness_surface.h"

namespace vitrine::inline codec {

// Records which triangles of a surface are close to the triangles that its patches have covered.
struct Overlaps {
  static constexpr std::uint32_t kNone = 0xFFFF'FFFFu;

  // Per triangle of the surface: the mark of the last cover() call that found the whole triangle
  // within `limit` of the triangle to cover; 0 if no call did.
  std::vector<std::uint16_t> mark;
  // Per triangle: number of the last cover() call that reached it, from 1; 0 if none did.
  std::vector<std::uint32_t> met;
  std::vector<std::uint32_t> calls;  // per call: the covered triangle, or kNone if the call failed

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
    // Whether every point of the triangle is within `height` of the surface.
    bool is_covered = false;
    // Upper bound of the distance, model units; at most `limit`, up to rounding. Also bounds the
    // distance of each marked triangle from `triangle`.
    double height = 0;
  };
  // Tries to cover `triangle` by a patch that starts at the surface's triangle `start`, which
  // should be near the centre of `triangle`. `number` is the caller's number for `triangle`. Stores
  // `mark` (not 0) for those triangles of the patch that lie within `limit` of `triangle`.
  CoverResult cover(const TrianglePoints& triangle, std::uint32_t number, std::uint32_t start,
                    double limit, std::uint16_t mark);

  Overlaps overlaps() && { return {std::move(marks_), std::move(met_), std::move(calls_)}; }

 private:
  using Lanes __attribute__((vector_size(16))) = float;
  struct Prism;
  // A point in the coordinates of the prism.
  struct PrismPoint {
    // Lane 0: height over the plane, negative below it. Lanes 1 to 3: distance from each wall,
    // positive inside the prism, times the length of the wall.
    Lanes at;
    float slack;    // error bound of `at`
    float squared;  // upper bound of the squared distance from the triangle
    unsigned bits;  // combination of kBeyond, kAside and kFar

    float height() const { return std::abs(at[0]) + slack; }
  };
  static constexpr unsigned kBeyond = 7;  // bit k: the point is proven to be beyond wall k
  // Two bits per wall: the point is proven to be on one side of `centre`.
  static constexpr unsigned kAside = 63 << 3;
  static constexpr unsigned kFar = 1 << 9;  // the point is farther away than kFarthest
  // A triangle to examine. `edge` is the edge across which the patch reached it, from corner `edge`
  // to the next.
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
  std::vector<std::uint32_t> met_, calls_;  // see Overlaps
  std::uint16_t mark_ = 0;
  std::uint32_t call_ = 0;
  std::vector<OpenTriangle> open_;
  int degree_ = 0;     // degree of the patch so far
  float height_ = 0;   // height of the patch so far, in units of the prism
  float squared_ = 0;  // largest squared distance of a marked triangle, in units of the prism
};

}  // namespace vitrine::inline codec
