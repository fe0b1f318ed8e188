// SPDX-License-Identifier: Apache-2.0
#include "server/report/single_files.h"

#include <meshoptimizer.h>

#include <cmath>
#include <optional>

#include "codec/export/write_drc.h"
#include "codec/mesh/surface_distance.h"

namespace vitrine {
namespace {

constexpr int kTargets = 14;
constexpr int kFewestBits = 8;
constexpr MeasureOptions kMeasure{.samples = 20'000};

class Simplifier {
 public:
  explicit Simplifier(const TriangleMesh& mesh) : mesh_(mesh) {
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
    TriangleMesh out;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const std::uint32_t v = corners[i];
      if (renamed[v] == kAbsent) {
        renamed[v] = static_cast<std::uint32_t>(out.positions.size());
        out.positions.push_back(mesh_.positions[v]);
        if (!mesh_.colours.empty()) out.colours.push_back(mesh_.colours[v]);
      }
      if (i % 3 == 0) out.faces.emplace_back();
      out.faces.back()[i % 3] = renamed[v];
    }
    return out;
  }

  const TriangleMesh& mesh_;
  std::vector<float> positions_;
  std::vector<std::uint32_t> indices_;
};

// On the grid where bytes times error are least, from the finest down as long as that pays; nothing
// where Draco cannot code the mesh.
std::optional<SingleFile> best_file(const TriangleMesh& mesh, const TriangleBvh& original,
                                    int most_bits) {
  const auto cost = [](const SingleFile& f) { return static_cast<double>(f.bytes) * f.rms_error; };
  std::optional<SingleFile> best;
  for (int bits = most_bits; bits >= kFewestBits; --bits) {
    const TriangleMesh rounded = to_model(quantise(mesh, fit_lattice(mesh.positions, bits)));
    const auto drc = write_drc(rounded, {.bits = bits, .effort = 10});
    if (!drc) return best;
    const SingleFile file{drc->size(), rms_distance(TriangleBvh(rounded), original, kMeasure)};
    if (best && cost(file) >= cost(*best)) break;
    best = file;
  }
  return best;
}

}  // namespace

std::vector<SingleFile> single_files(const TriangleMesh& original, std::size_t fewest,
                                     int most_bits, const std::function<void(double)>& progress) {
  const TriangleBvh surface(original);
  const Simplifier simplifier(original);
  const auto all = static_cast<double>(original.faces.size());
  std::vector<SingleFile> files;
  for (int i = 0; i < kTargets; ++i) {
    progress(static_cast<double>(i) / kTargets);
    const double share = std::pow(static_cast<double>(fewest) / all, 1 - i / (kTargets - 1.0));
    const TriangleMesh mesh = simplifier.simplify(static_cast<std::size_t>(std::ceil(share * all)));
    if (mesh.faces.empty()) continue;
    const auto file = best_file(mesh, surface, most_bits);
    if (!file || (!files.empty() && file->rms_error >= files.back().rms_error)) continue;
    while (!files.empty() && files.back().bytes >= file->bytes)
      files.pop_back();
    files.push_back(*file);
  }
  return files;
}

}  // namespace vitrine
