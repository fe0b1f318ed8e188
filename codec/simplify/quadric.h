// SPDX-License-Identifier: Apache-2.0
// Quadric error metric [GH97]: the weighted sum of a point's squared distances to planes.
#pragma once

#include "codec/core/vec.h"

namespace vitrine::inline codec {

struct Quadric {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;  // sum of weight * normal * normal^T
  double x = 0, y = 0, z = 0;                             // sum of weight * normal * offset
  double c = 0;                                           // sum of weight * offset^2

  // Returns the total weight of the planes. This is the trace of the matrix, because normals have
  // unit length.
  double weight() const { return xx + yy + zz; }

  Quadric& operator+=(const Quadric& o) {
    xx += o.xx, xy += o.xy, xz += o.xz, yy += o.yy, yz += o.yz, zz += o.zz;
    x += o.x, y += o.y, z += o.z, c += o.c;
    return *this;
  }

  // Returns the error at p: the weighted sum of squared distances from p to the planes. Rounding
  // may make the result slightly negative.
  double at(const Vec3& p) const {
    return p.x * (xx * p.x + 2 * (xy * p.y + xz * p.z + x)) +
           p.y * (yy * p.y + 2 * (yz * p.z + y)) + p.z * (zz * p.z + 2 * z) + c;
  }

  // Returns how much the error decreases if p moves along the gradient to the minimum on that line.
  // This is one step of steepest descent.
  double mendable(const Vec3& p) const {
    const Vec3 slope{xx * p.x + xy * p.y + xz * p.z + x, xy * p.x + yy * p.y + yz * p.z + y,
                     xz * p.x + yz * p.y + zz * p.z + z};
    const double square = dot(slope, slope);
    const double bend = slope.x * (xx * slope.x + 2 * (xy * slope.y + xz * slope.z)) +
                        slope.y * (yy * slope.y + 2 * yz * slope.z) + zz * slope.z * slope.z;
    return bend > 0 ? square * square / bend : 0;
  }
};

// Returns the quadric of the plane through the point `p` with the unit normal `normal`.
inline Quadric plane_quadric(const Vec3& normal, const Vec3& p, double weight) {
  const double offset = -dot(normal, p);
  const Vec3 n = normal * weight;
  return {n.x * normal.x, n.x * normal.y, n.x * normal.z, n.y * normal.y, n.y * normal.z,
          n.z * normal.z, n.x * offset,   n.y * offset,   n.z * offset,   weight * offset * offset};
}

}  // namespace vitrine::inline codec
