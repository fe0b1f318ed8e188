// SPDX-License-Identifier: Apache-2.0
#include "acquisition/profile/fit_polyline.h"

#include <algorithm>
#include <cmath>

namespace vitrine::acquisition {
namespace {

struct Flat {
  double rho = 0, z = 0;
};

Flat operator-(const TablePoint& a, const TablePoint& b) {
  return {a.rho - b.rho, a.z - b.z};
}
double dot(const Flat& a, const Flat& b) {
  return a.rho * b.rho + a.z * b.z;
}

// Returns the unit normal of `along`, or zero if `along` is zero.
Flat across(const Flat& along) {
  const double length = std::hypot(along.rho, along.z);
  return length > 0 ? Flat{-along.z / length, along.rho / length} : Flat{};
}

struct EquationRow {
  // The diagonal element. Its start value acts like two points at the corner, so that a corner with
  // few real points stays in place.
  double own = 2;
  double next = 0;  // matrix element that couples this corner to the next corner
  double right = 0;
};

// Solves a tridiagonal system by Thomas' algorithm.
std::vector<double> solve(std::vector<EquationRow> rows) {
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const double share = rows[i - 1].next / rows[i - 1].own;
    rows[i].own -= share * rows[i - 1].next;
    rows[i].right -= share * rows[i - 1].right;
  }
  std::vector<double> solution(rows.size());
  for (std::size_t i = rows.size(); i-- > 0;) {
    const double after = i + 1 < rows.size() ? rows[i].next * solution[i + 1] : 0;
    solution[i] = (rows[i].right - after) / rows[i].own;
  }
  return solution;
}

}  // namespace

void fit_polyline(std::span<const ProfilePoint> points, std::span<PolylineVertex> corners) {
  if (corners.size() < 2) return;
  std::vector<Flat> normals;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const PolylineVertex& before = corners[i > 0 ? i - 1 : 0];
    const PolylineVertex& after = corners[std::min(i + 1, corners.size() - 1)];
    normals.push_back(across(after.point.at - before.point.at));
  }
  std::vector<EquationRow> rows(corners.size());
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    const TablePoint& from = corners[i].point.at;
    const Flat along = corners[i + 1].point.at - from, normal = across(along);
    const double squared = dot(along, along);
    if (squared == 0) continue;
    const double a = dot(normals[i], normal), b = dot(normals[i + 1], normal);
    const auto first = static_cast<std::size_t>(std::ceil(corners[i].index));
    for (std::size_t p = first; static_cast<double>(p) < corners[i + 1].index; ++p) {
      const Flat offset = points[p].at - from;
      const double t = std::clamp(dot(offset, along) / squared, 0., 1.);
      const double distance = dot(offset, normal), here = (1 - t) * a, there = t * b;
      rows[i].own += here * here, rows[i].next += here * there, rows[i].right += here * distance;
      rows[i + 1].own += there * there, rows[i + 1].right += there * distance;
    }
  }
  const std::vector<double> moves = solve(std::move(rows));
  for (std::size_t i = 0; i < corners.size(); ++i) {
    corners[i].point.at.rho += moves[i] * normals[i].rho;
    corners[i].point.at.z += moves[i] * normals[i].z;
  }
}

}  // namespace vitrine::acquisition
