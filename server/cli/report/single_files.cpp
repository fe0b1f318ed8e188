// SPDX-License-Identifier: Apache-2.0
#include "server/cli/report/single_files.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "codec/distance/surface_distance.h"
#include "codec/export/write_drc.h"

namespace vitrine::server {
namespace {

constexpr int kTargets = 14;
constexpr int kFewestBits = 8;
constexpr MeasureOptions kMeasure{.samples = 20'000};
// Cost of sampling a mesh, as a number of faces that take equally long to encode. Used only to
// estimate the progress.
constexpr double kSampling = 180'000;

class MeshoptSimplifier {
 public:
  explicit MeshoptSimplifier(const TriangleMesh& mesh) : mesh_(mesh) {
    positions_.reserve(3 * mesh.positions.size());
    for (const Vec3& p : mesh.positions) {
      for (const double x : {p.x, p.y, p.z})
        positions_.push_back(static_cast<float>(x));
    }
    indices_.reserve(3 * mesh.faces.size());
    for (const Triangle& f : mesh.faces)
      indices_.insert(indices_.end(), f.begin(), f.end());
  }

  TriangleMesh simplify(std::size_t faces) const {
    if (faces >= mesh_.faces.size()) return mesh_;
    std::vector<std::uint32_t> left(indices_.size());
    left.resize(meshopt_simplify(left.data(), indices_.data(), indices_.size(), positions_.data(),
                                 mesh_.positions.size(), 3 * sizeof(float), 3 * faces, 1.0f));
    return compact(left);
  }

 private:
  TriangleMesh compact(const std::vector<std::uint32_t>& corners) const {
    constexpr std::uint32_t kAbsent = 0xFFFF'FFFFu;
    std::vector<std::uint32_t> renamed(mesh_.positions.size(), kAbsent);
    std::vector<std::uint32_t> kept;
    TriangleMesh out;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const std::uint32_t v = corners[i];
      if (renamed[v] == kAbsent) {
        renamed[v] = static_cast<std::uint32_t>(out.positions.size());
        kept.push_back(v);
        out.positions.push_back(mesh_.positions[v]);
      }
      if (i % 3 == 0) out.faces.emplace_back();
      out.faces.back()[i % 3] = renamed[v];
    }
    out.attributes = mesh_.attributes.gather(kept.size(), [&](std::size_t v) { return kept[v]; });
    return out;
  }

  const TriangleMesh& mesh_;
  std::vector<float> positions_;
  std::vector<std::uint32_t> indices_;
};

// Adds one file for each quantisation grid, from the coarsest to the finest. Skips a grid if Draco
// cannot encode the mesh on it.
void add_files(const TriangleMesh& mesh, const TriangleBvh& original, int most_bits,
               std::vector<SingleFile>& files) {
  for (int bits = kFewestBits; bits <= most_bits; ++bits) {
    const TriangleMesh rounded = to_model(quantise(mesh, fit_lattice(mesh.positions, bits)));
    if (const auto drc = write_drc(rounded, {.bits = bits, .effort = 10}))
      files.push_back({drc->size(), rms_distance(TriangleBvh(rounded), original, kMeasure)});
  }
}

// Returns face counts from `fewest` to `most`, evenly spaced on a logarithmic scale.
std::vector<double> face_counts(std::size_t fewest, std::size_t most) {
  const auto all = static_cast<double>(most);
  std::vector<double> counts;
  counts.reserve(kTargets);
  for (int i = 0; i < kTargets; ++i)
    counts.push_back(all * std::pow(static_cast<double>(fewest) / all, 1 - i / (kTargets - 1.0)));
  return counts;
}

// Returns the files for which no smaller file is as accurate.
std::vector<SingleFile> best_of(std::vector<SingleFile> files) {
  std::ranges::sort(files, {}, [](const SingleFile& f) { return std::pair(f.bytes, f.rms_error); });
  std::vector<SingleFile> best;
  for (const SingleFile& file : files) {
    if (best.empty() || file.rms_error < best.back().rms_error) best.push_back(file);
  }
  return best;
}

}  // namespace

std::vector<SingleFile> single_files(const TriangleMesh& original, std::size_t fewest,
                                     int most_bits, const std::function<void(double)>& progress) {
  const TriangleBvh surface(original);
  const MeshoptSimplifier simplifier(original);
  const std::vector<double> targets = face_counts(fewest, original.faces.size());
  const double work = std::accumulate(targets.begin(), targets.end(), kTargets * kSampling);
  double done = 0;
  std::vector<SingleFile> files;
  for (const double faces : targets) {
    progress(done / work);
    const TriangleMesh mesh = simplifier.simplify(static_cast<std::size_t>(std::ceil(faces)));
    if (!mesh.faces.empty()) add_files(mesh, surface, most_bits, files);
    done += kSampling + faces;
  }
  return best_of(std::move(files));
}

}  // namespace vitrine::server
