// SPDX-License-Identifier: Apache-2.0
#include "acquisition/rig_optics/stripe_band.h"

#include <algorithm>
#include <cmath>

namespace vitrine::acquisition::rig {
namespace {

// Width in pixels of the margin to the left and right that the lens's blur lights. The margin above
// and below is one row.
constexpr int kMargin = 2;
// Length in pixels over which the distortion of a line is negligible.
constexpr double kStraight = 10;

using Rows = std::vector<std::vector<PixelRun>>;

// Clips a convex polygon. Keeps the points p with side(p) >= 0.
template <class Side>
void clip(std::vector<Vec3>& polygon, std::vector<Vec3>& scratch, const Side& side) {
  scratch.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double at_a = side(a), at_b = side(b);
    if (at_a >= 0) scratch.push_back(a);
    if ((at_a >= 0) != (at_b >= 0)) scratch.push_back(a + (b - a) * (at_a / (at_a - at_b)));
  }
  polygon.swap(scratch);
}

// Rasterises one polygon from its outline. Finds the rows that the polygon covers, and its extent
// in each row.
class PolygonRaster {
 public:
  void add_edge(const Lens& lens, const Vec3& a, const Vec3& b) {
    const auto from = project(lens, a), to = project(lens, b);
    if (!from || !to) return;
    const double span = std::max(std::abs(to->u - from->u), std::abs(to->v - from->v));
    if (span > kStraight && length(b - a) > 0.01) {
      const Vec3 middle = (a + b) * 0.5;
      add_edge(lens, a, middle);
      add_edge(lens, middle, b);
      return;
    }
    const int pieces = 1 + static_cast<int>(span);
    for (int i = 0; i <= pieces; ++i) {
      const double t = static_cast<double>(i) / pieces;
      add(from->u + t * (to->u - from->u), from->v + t * (to->v - from->v));
    }
  }

  void move_into(Rows& rows) {
    for (std::size_t i = 0; i < extents_.size(); ++i) {
      if (extents_[i].first <= extents_[i].last)
        rows[static_cast<std::size_t>(first_) + i].push_back(extents_[i]);
    }
    extents_.clear();
  }

 private:
  void add(double u, double v) {
    const int row = static_cast<int>(std::lround(v)), column = static_cast<int>(std::lround(u));
    const int low = std::max(0, column - kMargin);
    const int high = std::min(kSensorWidth - 1, column + kMargin);
    for (int r = std::max(0, row - 1); r <= std::min(kSensorHeight - 1, row + 1); ++r)
      extend(r, low, high);
  }

  void extend(int row, int low, int high) {
    if (low > high) return;
    if (extents_.empty()) first_ = row;
    if (row < first_) {
      extents_.insert(extents_.begin(), static_cast<std::size_t>(first_ - row), kNone);
      first_ = row;
    }
    const auto at = static_cast<std::size_t>(row - first_);
    if (at >= extents_.size()) extents_.resize(at + 1, kNone);
    extents_[at] = {std::min(extents_[at].first, low), std::max(extents_[at].last, high)};
  }

  static constexpr PixelRun kNone{kSensorWidth, -1};
  int first_ = 0;
  std::vector<PixelRun> extents_;
};

void merge(std::vector<PixelRun>& runs) {
  std::sort(runs.begin(), runs.end(),
            [](const PixelRun& a, const PixelRun& b) { return a.first < b.first; });
  std::size_t kept = 0;
  for (const PixelRun& run : runs) {
    if (kept > 0 && run.first <= runs[kept - 1].last + 1) {
      runs[kept - 1].last = std::max(runs[kept - 1].last, run.last);
    } else {
      runs[kept++] = run;
    }
  }
  runs.resize(kept);
}

// Returns whether a face can show laser light. Camera and laser must be on the same side of the
// face.
bool can_show(const LocalOptics& optics, Subject::ConvexPolygon face) {
  const Vec3 normal = cross(face[1] - face[0], face[2] - face[0]);
  return dot(normal, optics.camera.at - face[0]) * dot(normal, optics.laser.source - face[0]) > 0;
}

}  // namespace

std::vector<std::vector<PixelRun>> stripe_band(const LocalOptics& optics, const Subject& subject,
                                               double half) {
  Rows rows(kSensorHeight);
  PolygonRaster outline;
  std::vector<Vec3> polygon, scratch;
  const LaserSheet& laser = optics.laser;
  const auto visit = [&](Subject::ConvexPolygon face) {
    if (!can_show(optics, face)) return;
    polygon.assign(face.begin(), face.end());
    clip(polygon, scratch,
         [&](const Vec3& p) { return half - (dot(laser.normal, p) - laser.offset); });
    clip(polygon, scratch,
         [&](const Vec3& p) { return half + (dot(laser.normal, p) - laser.offset); });
    for (std::size_t i = 0; i < polygon.size(); ++i)
      outline.add_edge(optics.camera, polygon[i], polygon[(i + 1) % polygon.size()]);
    outline.move_into(rows);
  };
  subject.near_plane(laser.normal, laser.offset, half, visit);
  for (std::vector<PixelRun>& row : rows)
    merge(row);
  return rows;
}

}  // namespace vitrine::acquisition::rig
