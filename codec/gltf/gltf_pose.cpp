// SPDX-License-Identifier: Apache-2.0
#include "codec/gltf/gltf_pose.h"

#include <algorithm>
#include <string>

#include "codec/gltf/gltf_document.h"

namespace vitrine::inline codec {
namespace {

// Largest number of morph targets that are applied to a primitive. Bounds the work for a vertex.
constexpr std::size_t kMostTargets = 1024;

// Returns matrix i, which is stored in column-major order.
Affine matrix_at(const Accessor& matrices, std::uint64_t i) {
  const auto column = [&](std::uint32_t k) {
    return Vec3{matrices.real(i, 4 * k), matrices.real(i, 4 * k + 1), matrices.real(i, 4 * k + 2)};
  };
  return {column(0), column(1), column(2), column(3)};
}

}  // namespace

Expected<Joints> joints_of(const Json& document, GltfBuffer& buffer, std::uint64_t node,
                           std::span<const Affine> places) {
  const std::uint64_t number = whole(element(document, "nodes", node), "skin", kAbsent);
  if (number == kAbsent) return Joints{};
  const Json& skin = element(document, "skins", number);
  const std::uint64_t inverses = whole(skin, "inverseBindMatrices", kAbsent);
  Accessor matrices;
  if (inverses != kAbsent) {
    const auto opened = Accessor::open(document, buffer, inverses);
    if (!opened) return tl::unexpected(opened.error());
    if (opened->width() != 16)
      return bad_gltf("the inverse bind matrices of skin " + std::to_string(number) +
                      " are not MAT4");
    matrices = *opened;
  }
  Joints out;
  for (const Json& joint : member(skin, "joints")) {
    const std::uint64_t index = joint.is_number_unsigned() ? joint.get<std::uint64_t>() : kAbsent;
    if (index >= places.size() || (inverses != kAbsent && out.size() >= matrices.count()))
      return bad_gltf("a joint of skin " + std::to_string(number) + " does not exist");
    const Affine& place = places[index];
    out.push_back(inverses == kAbsent ? place : place * matrix_at(matrices, out.size()));
  }
  if (out.empty()) return bad_gltf("skin " + std::to_string(number) + " has no joints");
  return out;
}

std::vector<double> morph_weights(const Json& document, const MeshInstance& instance) {
  const Json& own = member(element(document, "nodes", instance.node), "weights");
  const Json& weights =
      own.is_array() ? own : member(element(document, "meshes", instance.mesh), "weights");
  std::vector<double> out;
  for (const Json& weight : weights)
    out.push_back(weight.is_number() ? weight.get<double>() : 0);
  return out;
}

Expected<void> GltfPose::read(const Json& document, GltfBuffer& buffer,
                              const GltfPrimitive& primitive, std::uint64_t count,
                              std::span<const double> weights) {
  count_ = count;
  const Json& targets = member(primitive.json, "targets");
  for (std::size_t t = 0; targets.is_array() && t < std::min(targets.size(), weights.size()); ++t) {
    const std::uint64_t accessor = whole(targets[t], "POSITION", kAbsent);
    if (weights[t] == 0 || accessor == kAbsent) continue;
    const auto offsets = Accessor::open(document, buffer, accessor, primitive.needed);
    if (offsets && offsets->width() == 3 && offsets->count() >= count_ &&
        targets_.size() < kMostTargets)
      targets_.emplace_back(weights[t], *offsets);
    else
      ++dropped_targets_;
  }
  if (joints_.empty()) return {};
  place_ = primitive.has("JOINTS_0") ? joints_.front() : Affine{};
  for (const std::string_view set : {"0", "1"}) {
    if (auto ok = add_influences(document, buffer, primitive, set); !ok) return ok;
  }
  return {};
}

Expected<void> GltfPose::add_influences(const Json& document, GltfBuffer& buffer,
                                        const GltfPrimitive& primitive, std::string_view set) {
  const std::string joints = "JOINTS_" + std::string(set), weights = "WEIGHTS_" + std::string(set);
  if (!primitive.has(joints) || !primitive.has(weights)) return {};
  const auto numbers = primitive.open(document, buffer, joints);
  if (!numbers) return tl::unexpected(numbers.error());
  auto shares = primitive.open(document, buffer, weights);
  if (!shares) return tl::unexpected(shares.error());
  if (numbers->width() != 4 || shares->width() != 4)
    return bad_gltf(joints + " and " + weights + " are not VEC4");
  if (numbers->count() < count_ || shares->count() < count_)
    return bad_gltf(joints + " and " + weights + " do not match POSITION");
  shares->normalise();
  influences_.push_back({*numbers, *shares});
  return {};
}

Vec3 GltfPose::skinned(std::uint64_t i, const Vec3& p) const {
  Vec3 sum;
  double total = 0;
  for (const auto& [joints, weights] : influences_) {
    for (std::uint32_t k = 0; k < 4; ++k) {
      const double weight = weights.real(i, k), joint = joints.real(i, k);
      if (!(weight > 0) || !(joint >= 0 && joint < static_cast<double>(joints_.size()))) continue;
      sum += joints_[static_cast<std::size_t>(joint)](p) * weight;
      total += weight;
    }
  }
  return total > 0 ? sum * (1 / total) : place_(p);
}

Vec3 GltfPose::operator()(std::uint64_t i, Vec3 p) const {
  for (const auto& [weight, offsets] : targets_)
    p += Vec3{offsets.real(i, 0), offsets.real(i, 1), offsets.real(i, 2)} * weight;
  return influences_.empty() ? place_(p) : skinned(i, p);
}

}  // namespace vitrine::inline codec
