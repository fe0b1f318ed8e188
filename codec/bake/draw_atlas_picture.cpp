// SPDX-License-Identifier: Apache-2.0
#include "codec/bake/draw_atlas_picture.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "codec/bake/role_maps.h"
#include "codec/bake/tangent_frame.h"

namespace vitrine::inline codec {
namespace {

constexpr std::uint32_t kSamplesOfTexel = 2;  // number of samples on each axis

ScreenTriangle in_samples(const DisplayFace& face, std::uint32_t side) {
  const double scale = static_cast<double>(side) * kSamplesOfTexel;
  std::array<Vec3, 3> corners;
  for (std::size_t k = 0; k < 3; ++k)
    corners[k] = {face[k].x * scale, face[k].y * scale, 0};
  return ScreenTriangle(corners);
}

// Reads the values of one face at sample points.
class FaceValues {
 public:
  FaceValues(PictureRole role, std::uint32_t face, const TriangleMesh& mesh,
             const Textures& textures, const DisplayFace& display, const ScreenTriangle& triangle)
      : role_(role), material_(textures.material(face)) {
    const auto maps = maps_of(role);
    for (std::size_t i = 0; i < maps.size(); ++i)
      maps_[i] = textures.map(maps[i], face, triangle);
    if (role == PictureRole::kNormal && maps_[0]) {
      turn_.emplace(mesh, mesh.faces[face], maps_[0]->corners(), display);
    }
  }

  TexelValue at(const Barycentric& weights) const {
    switch (role_) {
      case PictureRole::kBaseColour:
        return base_colour(texel(0, weights));
      case PictureRole::kNormal:
        return normal(weights);
      case PictureRole::kSurface:
        return surface(texel(0, weights), texel(1, weights));
      case PictureRole::kEmission:
        return emission(texel(0, weights));
    }
    return {};
  }

 private:
  // Returns the value of a map, or white if the material lacks this map.
  Texel texel(std::size_t map, const Barycentric& weights) const {
    return maps_[map] ? maps_[map]->at(weights) : Texel{1, 1, 1, 1};
  }

  TexelValue base_colour(const Texel& map) const {
    TexelValue out;
    for (std::size_t k = 0; k < out.size(); ++k)
      out[k] = static_cast<float>(material_.base_colour[k]) * map[k];
    return out;
  }

  TexelValue normal(const Barycentric& weights) const {
    if (!turn_) return {0.5f, 0.5f, 1, 1};
    const Texel map = texel(0, weights);
    const Vec2 across = Vec2{2.0 * map[0] - 1, 2.0 * map[1] - 1} * material_.normal_scale;
    const Vec2 turned = (*turn_)(across);
    const double up = 2.0 * map[2] - 1;
    const double size = std::sqrt(dot(turned, turned) + up * up);
    const double half = size > 0 ? 0.5 / size : 0;
    return {static_cast<float>(0.5 + half * turned.x), static_cast<float>(0.5 + half * turned.y),
            static_cast<float>(0.5 + half * up), 1};
  }

  TexelValue surface(const Texel& metallic_roughness, const Texel& occlusion) const {
    const double occluded = 1 + material_.occlusion_strength * (occlusion[0] - 1);
    return {static_cast<float>(occluded),
            static_cast<float>(material_.roughness) * metallic_roughness[1],
            static_cast<float>(material_.metallic) * metallic_roughness[2], 1};
  }

  TexelValue emission(const Texel& map) const {
    const Vec3& factor = material_.emission;
    return {static_cast<float>(factor.x) * map[0], static_cast<float>(factor.y) * map[1],
            static_cast<float>(factor.z) * map[2], 1};
  }

  PictureRole role_;
  const Material& material_;
  std::array<std::optional<FaceTexture>, 2> maps_;
  std::optional<TangentTurn> turn_;  // set only for a normal map
};

// The four texels from which a sample is interpolated, and their weights.
class TexelsAround {
 public:
  TexelsAround(std::uint32_t x, std::uint32_t y, std::uint32_t side) {
    const auto [left, right_weight] = axis(x);
    const auto [top, bottom_weight] = axis(y);
    const auto inside = [side](std::int64_t i) {
      return static_cast<std::size_t>(std::clamp<std::int64_t>(i, 0, std::int64_t{side} - 1));
    };
    for (std::size_t k = 0; k < 4; ++k) {
      const bool is_right = k % 2 == 1, is_bottom = k / 2 == 1;
      texels_[k] = inside(top + (is_bottom ? 1 : 0)) * side + inside(left + (is_right ? 1 : 0));
      weights_[k] = (is_right ? right_weight : 1 - right_weight) *
                    (is_bottom ? bottom_weight : 1 - bottom_weight);
    }
  }

  // Adds `value` times the weight of each texel to `sums`, and the weight itself to `totals`.
  void add(const TexelValue& value, std::vector<TexelValue>& sums,
           std::vector<float>& totals) const {
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t i = 0; i < value.size(); ++i)
        sums[texels_[k]][i] += weights_[k] * value[i];
      totals[texels_[k]] += weights_[k];
    }
  }

  TexelValue mixed(const std::vector<TexelValue>& texels) const {
    TexelValue out{};
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t i = 0; i < out.size(); ++i)
        out[i] += weights_[k] * texels[texels_[k]][i];
    }
    return out;
  }

 private:
  static std::pair<std::int64_t, float> axis(std::uint32_t sample) {
    const double at = (sample + 0.5) / kSamplesOfTexel - 0.5;
    const double first = std::floor(at);
    return {static_cast<std::int64_t>(first), static_cast<float>(at - first)};
  }

  std::array<std::size_t, 4> texels_;
  std::array<float, 4> weights_;
};

// Fits a picture to samples of the source by least squares: its interpolated values then differ
// least from the samples. Each round corrects each texel by the mean of the remaining differences
// near the texel.
class Fit {
 public:
  Fit(PictureRole role, std::uint32_t side, const TriangleMesh& mesh, const Textures& textures,
      std::span<const DisplayFace> display)
      : role_(role), mesh_(mesh), textures_(textures), display_(display) {
    picture_.side = side;
    picture_.texels.resize(std::size_t{side} * side);
    picture_.covered.resize(picture_.texels.size());
    sums_.resize(picture_.texels.size());
  }

  AtlasPicture run() {
    for (int round = 0; round < kRounds; ++round)
      correct(round == 0 ? 1 : kOvershoot);
    for (float& covered : picture_.covered)
      covered = std::min(1.0f, covered / (kSamplesOfTexel * kSamplesOfTexel));
    return std::move(picture_);
  }

 private:
  static constexpr int kRounds = 4;
  static constexpr float kOvershoot = 1.6f;

  void correct(float share) {
    std::fill(sums_.begin(), sums_.end(), TexelValue{});
    std::fill(picture_.covered.begin(), picture_.covered.end(), 0.0f);
    for (std::uint32_t face = 0; face < display_.size(); ++face)
      add_differences(face);
    for (std::size_t i = 0; i < sums_.size(); ++i) {
      if (picture_.covered[i] == 0) continue;
      for (std::size_t k = 0; k < 4; ++k)
        picture_.texels[i][k] += share * sums_[i][k] / picture_.covered[i];
    }
  }

  void add_differences(std::uint32_t face) {
    const ScreenTriangle triangle = in_samples(display_[face], picture_.side);
    if (triangle.signed_area() == 0) return;
    const FaceValues values(role_, face, mesh_, textures_, display_[face], triangle);
    const std::uint32_t samples = picture_.side * kSamplesOfTexel;
    const auto [left, right] = triangle.columns(samples);
    const auto [top, bottom] = triangle.rows(samples);
    for (std::uint32_t y = top; y < bottom; ++y) {
      for (std::uint32_t x = left; x < right; ++x) {
        const Barycentric weights = triangle.at(x, y);
        if (!weights.is_inside()) continue;
        const TexelsAround around(x, y, picture_.side);
        TexelValue difference = values.at(weights);
        const TexelValue now = around.mixed(picture_.texels);
        for (std::size_t k = 0; k < 4; ++k)
          difference[k] -= now[k];
        around.add(difference, sums_, picture_.covered);
      }
    }
  }

  PictureRole role_;
  const TriangleMesh& mesh_;
  const Textures& textures_;
  std::span<const DisplayFace> display_;
  AtlasPicture picture_;
  std::vector<TexelValue> sums_;
};

}  // namespace

AtlasPicture draw_atlas_picture(PictureRole role, std::uint32_t side, const TriangleMesh& mesh,
                                const Textures& textures, std::span<const DisplayFace> display) {
  return Fit(role, side, mesh, textures, display).run();
}

}  // namespace vitrine::inline codec
