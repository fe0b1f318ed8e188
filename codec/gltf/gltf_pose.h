// SPDX-License-Identifier: Apache-2.0
// Computes where the vertices of a glTF primitive are in the scene. First applies the morph targets
// with the weights of the file. Then applies the skin, or the node's transform if the node has no
// skin ([glTF] sections 3.7.2.2 and 3.7.3).
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "codec/gltf/affine.h"
#include "codec/gltf/gltf_primitive.h"
#include "codec/gltf/gltf_scene.h"

namespace vitrine::inline codec {

// The joints of a skin: maps from the coordinates of the skinned mesh to scene coordinates. Empty
// if the node has no skin.
using Joints = std::vector<Affine>;

// Reads the skin of node number `node`. Fails (kBadInput) if a joint does not exist or the matrices
// cannot be read.
Expected<Joints> joints_of(const Json& document, GltfBuffer& buffer, std::uint64_t node,
                           std::span<const Affine> places);

// Returns the weights of the mesh's morph targets. A node may override the weights of its mesh.
std::vector<double> morph_weights(const Json& document, const MeshInstance& instance);

class GltfPose {
 public:
  // `place` is the node's transform, which applies if `joints` is empty. `joints` must outlive this
  // object.
  GltfPose(const Affine& place, const Joints& joints) : place_(place), joints_(joints) {}

  // Reads the attributes that determine the positions of the `count` vertices of a primitive.
  // `weights` are the weights of the morph targets. Fails (kBadInput) if the skin's attributes
  // cannot be read.
  Expected<void> read(const Json& document, GltfBuffer& buffer, const GltfPrimitive& primitive,
                      std::uint64_t count, std::span<const double> weights);

  // Returns the position of vertex i, which is at `p` in the file.
  Vec3 operator()(std::uint64_t i, Vec3 p) const;
  bool mirrors() const { return place_.mirrors(); }
  // Returns the number of morph targets with a non-zero weight that are ignored because their data
  // does not match the primitive.
  std::uint64_t dropped_targets() const { return dropped_targets_; }

 private:
  struct Influences {
    Accessor joints, weights;
  };
  Expected<void> add_influences(const Json& document, GltfBuffer& buffer,
                                const GltfPrimitive& primitive, std::string_view set);
  Vec3 skinned(std::uint64_t i, const Vec3& p) const;

  Affine place_;
  std::span<const Affine> joints_;
  std::vector<Influences> influences_;
  std::vector<std::pair<double, Accessor>> targets_;
  std::uint64_t count_ = 0, dropped_targets_ = 0;
};

}  // namespace vitrine::inline codec
