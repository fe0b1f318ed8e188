// SPDX-License-Identifier: Apache-2.0
// Bounds the distance of a triangle to a surface by a patch of the surface that lies over it.
//
// The patch is what one meets from a first triangle on across edges, as long as these reach into
// the prism over T (the points whose projection to T's plane lies in T). If no border edge does,
// then the projection of the patch to T has a degree: as many of its triangles cover one point of T
// as any other, those that face down counted as less than none. If it is not 0, each point of T has
// a point of the patch at right angles above or below it, no farther away than the patch is high
// over T.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "codec/simplify/witness_surface.h"

namespace vitrine {

// What was learned of the triangles of a surface while patches of it covered others.
struct Overlaps {
  static constexpr std::uint32_t kNone = 0xFFFF'FFFFu;

  // The newest mark (not 0) of a triangle given that all of it is near, within the limit.
  std::vector<std::uint16_t> mark;
  std::vector<std::uint32_t> met;    // the newest call that met it, from 1 on, or 0
  std::vector<std::uint32_t> calls;  // the triangle that each was for; kNone where it failed

  // A triangle given that triangle t is near, if any is known.
  std::optional<std::uint32_t> near(std::uint32_t t) const {
    if (met.empty() || met[t] == 0 || calls[met[t] - 1] == kNone) return std::nullopt;
    return calls[met[t] - 1];
  }
};

class PatchCover {
 public:
  explicit PatchCover(const WitnessSurface& surface);

  struct Result {
    bool covered = false;  // every point of the triangle is within `height` of the surface
    double height = 0;     // at most `limit`, but for rounding; what was marked is within it, too
  };
  // `start` is a triangle of the surface near the centre of `triangle`, which the caller counts as
  // `number`.
  Result cover(const Corners& triangle, std::uint32_t number, std::uint32_t start, double limit,
               std::uint16_t mark);

  Overlaps overlaps() && { return {std::move(marks_), std::move(met_), std::move(calls_)}; }

 private:
  using Lanes __attribute__((vector_size(16))) = float;
  struct Prism;
  // Where a point is, in units of the prism.
  struct Place {
    Lanes at;     // height over the plane (negative below), depth behind each wall times its length
    float slack;  // no less than what these may be wrong by
    float squared;  // no less than the squared distance from the triangle
    unsigned bits;  // kBeyond and what follows

    float height() const { return std::abs(at[0]) + slack; }
  };
  static constexpr unsigned kBeyond = 7;       // bit k: surely not behind wall k
  static constexpr unsigned kAside = 63 << 3;  // two for each wall: surely to a side of `centre`
  static constexpr unsigned kFar = 1 << 9;     // too far away to be placed
  // A triangle to look at, and the edge by which it was reached, corner k to the next.
  struct Open {
    std::uint32_t triangle, edge;
    Place from, to;
  };
  static float area(const Lanes& a, const Lanes& b, const Lanes& c);
  static float height_inside(const Place& a, const Place& b, const Place& c);
  float height(const Prism& prism, const Open& open, const Place& apex) const;
  bool lay(const Prism& prism, std::uint32_t start);
  bool step(const Prism& prism, const Open& open);
  bool count(const Place& a, const Place& b, const Place& c, const Lanes& centre);
  static bool passes_by(const Prism& prism, const Place& from, const Place& to);
  bool cross_edge(const Prism& prism, std::uint32_t triangle, std::uint32_t edge, const Place& from,
                  const Place& to);

  const WitnessSurface& surface_;
  std::vector<std::uint16_t> marks_;
  std::vector<std::uint32_t> met_, calls_;  // see Overlaps
  std::uint16_t mark_ = 0;
  std::uint32_t call_ = 0;
  std::vector<Open> open_;
  int degree_ = 0;     // of the patch so far
  float height_ = 0;   // of the patch so far, units of the prism
  float squared_ = 0;  // the largest squared distance of what was marked, likewise
};

}  // namespace vitrine
