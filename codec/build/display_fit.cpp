// SPDX-License-Identifier: Apache-2.0
#include "codec/build/display_fit.h"

#include <algorithm>
#include <unordered_map>

#include "codec/refine/display_filter.h"

namespace vitrine::inline codec {
namespace {

constexpr std::size_t kFaces = 1000;
// Share of the fitted strength that is used. The fit considers only the centroids of faces. Corners
// move farther than centroids, so the full strength would be too much. In measurements, a share of
// about 0.8 gave the smallest rms error.
constexpr double kShare = 0.8;

// Fits the factor `a` in offset = a * shift by least squares. `offset` is the signed distance from
// a face's centroid to the original surface, along the face's normal. `shift` is the distance by
// which the filter at full strength moves the centroid along this normal.
struct Fit {
  double product = 0, square = 0;

  void add(double offset, double shift, double weight) {
    product += weight * offset * shift;
    square += weight * shift * shift;
  }
};

class FaceSampler {
 public:
  FaceSampler(const MeshState& level, const Lattice& lattice, const WitnessSurface& original)
      : level_(level), lattice_(lattice), original_(original) {}

  void add_face(std::uint32_t face, Fit& fit) {
    std::array<Vec3, 3> at, shift;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const VertexId v = level_.connectivity.vertex(3 * face + k);
      const double offset = display_offset(level_.shift);
      at[k] = to_vec3(level_.positions[v]) + Vec3{offset, offset, offset};
      shift[k] = shift_of(v);
    }
    const Vec3 area = cross(at[1] - at[0], at[2] - at[0]);
    const double size = length(area);
    if (!(size > 0)) return;
    const Vec3 normal = area * (1 / size);
    const double third = 1.0 / 3;
    add_point((at[0] + at[1] + at[2]) * third, (shift[0] + shift[1] + shift[2]) * third, normal,
              size, fit);
  }

 private:
  // Computes each shift only once: faces share vertices, and a vertex may have as many neighbours
  // as the mesh has vertices.
  Vec3 shift_of(VertexId v) {
    const auto [known, is_new] = shifts_.try_emplace(v);
    if (is_new) known->second = display_shift(level_, v);
    return known->second;
  }

  void add_point(const Vec3& p, const Vec3& shift, const Vec3& normal, double weight, Fit& fit) {
    const Vec3 model = lattice_.origin + p * lattice_.step;
    nearest_ = original_.closest(model, nearest_).triangle;
    const Vec3 nearest = closest_point(original_.triangle(nearest_), model);
    const double offset = dot(nearest - model, normal) * (1 / lattice_.step);
    fit.add(offset, dot(shift, normal), weight);
  }

  const MeshState& level_;
  const Lattice& lattice_;
  const WitnessSurface& original_;
  std::unordered_map<VertexId, Vec3> shifts_;  // results of display_shift()
  std::uint32_t nearest_ = 0;  // the original's triangle nearest to the previous point
};

}  // namespace

double fit_display_filter(const MeshState& level, const Lattice& lattice,
                          const WitnessSurface& original) {
  FaceSampler sampler(level, lattice, original);
  const std::uint32_t faces = level.connectivity.face_count();
  const std::uint32_t stride = static_cast<std::uint32_t>(faces / kFaces + 1);
  Fit fit;
  for (std::uint32_t f = 0; f < faces; f += stride) {
    if (level.connectivity.is_real(f)) sampler.add_face(f, fit);
  }
  return fit.square > 0 ? std::clamp(kShare * fit.product / fit.square, 0.0, 1.0) : 0.0;
}

}  // namespace vitrine::inline codec
