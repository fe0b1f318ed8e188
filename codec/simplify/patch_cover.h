// SPDX-License-Identifier: Apache-2.0
// Bounds the distance of a triangle to a surface by a patch of the surface that lies over it.
//
// The patch is what one meets from a first triangle on across edges, as long as it reaches into
// the prism over T (the points whose projection to T's plane lies in T). If none of its triangles
// faces away from T and no border edge reaches into the prism, then its projection to T is open
// and closed in T, and so all of T if it is not empty: each point of T has a point of the patch at
// right angles above or below it, no farther away than the patch is high over T.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "codec/simplify/witness_surface.h"

namespace vitrine {

class PatchCover {
 public:
  explicit PatchCover(const WitnessSurface& surface);

  struct Result {
    bool covered = false;  // every point of the triangle is within `height` of the surface
    double height = 0;     // at most `limit`; bounds what was marked, too
  };
  // `start` is a triangle of the surface near the centre of `triangle`.
  Result cover(const Corners& triangle, std::uint32_t start, double limit, std::uint16_t mark);

  // Per triangle of the surface, the newest mark (not 0) of a triangle given that it was seen to
  // lie wholly over, within the limit.
  std::vector<std::uint16_t> marks() && { return std::move(marks_); }

 private:
  struct Prism;
  // Where a point is: height over the plane (negative below), depth behind each wall (negative
  // outside).
  struct Place {
    double height;
    std::array<double, 3> depth;
  };
  // A triangle to look at, and what is known of the edge it was reached by, corner k to the next.
  struct Open {
    std::uint32_t triangle, edge;
    Place from, to;
  };
  static bool outside(const Place& a, const Place& b);
  static bool outside(const Place& a, const Place& b, const Place& c);
  static double area(const Place& a, const Place& b, const Place& c);
  static bool inside(const Place& p);
  static Place between(const Place& a, const Place& b, double part);
  static double height_inside(const std::array<Place, 3>& places);
  bool step(const Prism& prism, const Open& open, double limit, Result& result, bool& over_centre);

  const WitnessSurface& surface_;
  std::vector<std::uint16_t> marks_;
  std::uint16_t mark_ = 0;
  std::vector<std::uint32_t> seen_;  // per triangle: the newest call that met it
  std::uint32_t call_ = 0;
  std::vector<Open> open_;
};

}  // namespace vitrine
