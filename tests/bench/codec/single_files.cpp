// SPDX-License-Identifier: Apache-2.0
#include "single_files.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "codec/distance/surface_distance.h"
#include "peer_simplifiers.h"
#include "peers.h"
#include "support/product_names.h"

namespace vitrine::bench {
namespace {

constexpr int kTargets = 14;
constexpr double kFewest = 0.004, kMost = 0.65;  // range of the targets, as shares of the faces
constexpr int kFewestBits = 8, kMostBits = 12;
constexpr std::size_t kSamples = 50'000;
constexpr std::size_t kFewestPoints = 12;  // a curve with fewer points is rejected

// Returns the numbers of faces to simplify to, evenly spaced on a logarithmic scale. They range
// from kFewest to kMost, as shares of the original's faces.
std::vector<std::size_t> targets(const TriangleMesh& original) {
  std::vector<std::size_t> out;
  for (int i = 0; i < kTargets; ++i) {
    const double share = kFewest * std::pow(kMost / kFewest, i / (kTargets - 1.0));
    out.push_back(static_cast<std::size_t>(share * static_cast<double>(original.faces.size())));
  }
  return out;
}

double interpolate(const CodedFile& a, const CodedFile& b, double error) {
  const double t = std::log(error / a.error) / std::log(b.error / a.error);
  return a.bytes * std::pow(b.bytes / a.bytes, t);
}

}  // namespace

double rms_percent(const TriangleMesh& mesh, const TriangleMesh& original) {
  const auto distance = measure(mesh, original, {.samples = kSamples});
  if (!distance) throw std::runtime_error(distance.error().message);
  return distance->rms_percent;
}

RateCurve::RateCurve(std::vector<CodedFile> points) {
  std::ranges::sort(points, {}, &CodedFile::bytes);
  for (const CodedFile& point : points) {
    if (points_.empty() || point.error < points_.back().error) points_.push_back(point);
  }
  if (points_.size() < kFewestPoints) throw std::runtime_error("the single files are too alike");
}

std::optional<double> RateCurve::bytes_at(double error) const {
  if (error > points_.front().error || error < points_.back().error) return {};
  std::size_t i = 1;
  while (i + 1 < points_.size() && points_[i].error > error)
    ++i;
  return interpolate(points_[i - 1], points_[i], error);
}

RateCurve single_files(const TriangleMesh& original) {
  std::vector<CodedFile> points;
  for (const Simplified& level : simplify_by_meshopt_update(original, targets(original))) {
    for (int bits = kFewestBits; bits <= kMostBits; ++bits) {
      const Bytes file = draco_encode(level.mesh, bits);
      points.push_back({static_cast<double>(file.size()), rms_percent(draco_mesh(file), original)});
    }
  }
  return RateCurve(std::move(points));
}

}  // namespace vitrine::bench
