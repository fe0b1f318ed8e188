// SPDX-License-Identifier: Apache-2.0
// Reads FBX: the polygons of all meshes that the scene places, with their materials.
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "codec/fbx/fbx_outline.h"
#include "codec/fbx/fbx_scene.h"
#include "codec/import/fbx_materials.h"
#include "codec/import/readers.h"
#include "codec/import/scene_mesh.h"
#include "codec/import/stated_colours.h"
#include "codec/mesh/unit.h"

namespace vitrine::inline codec {
namespace {

constexpr double kMetresPerCentimetre = 0.01;

StatedLength length_in(const FbxOutline& outline) {
  return stated_length(outline.centimetres * kMetresPerCentimetre, kMetresPerCentimetre);
}

Affine affine_of(const aiMatrix4x4& m) {
  return {{m.a1, m.b1, m.c1}, {m.a2, m.b2, m.c2}, {m.a3, m.b3, m.c3}, {m.a4, m.b4, m.c4}};
}

class FbxReader {
 public:
  FbxReader(const aiScene& scene, const Companions& companions, const FbxOutline& outline,
            const Limits& limits)
      : scene_(scene), outline_(outline), mesh_("FBX", companions, limits, outline.decoded_bytes) {}

  Expected<RawMesh> read() {
    materials_ = define_fbx_materials(scene_, mesh_.materials(), unread_);
    const Affine turn = to_y_up(outline_.up_axis, length_in(outline_).scale);
    if (scene_.mRootNode != nullptr) nodes_.push_back({scene_.mRootNode, turn});
    while (!nodes_.empty()) {
      const PlacedNode node = nodes_.back();
      nodes_.pop_back();
      if (auto ok = add(node); !ok) return tl::unexpected(ok.error());
    }
    if (!mesh_.has_faces())
      return bad_input("the FBX places no mesh with faces; export the model again");
    report();
    RawMesh out = std::move(mesh_).finish();
    out.translucent_colours = translucent_;
    return out;
  }

 private:
  struct PlacedNode {
    const aiNode* node;
    Affine outer;
  };

  Expected<void> add(const PlacedNode& placed) {
    const aiNode& node = *placed.node;
    const Affine here = placed.outer * affine_of(node.mTransformation);
    for (std::size_t i = 0; i < node.mNumMeshes; ++i) {
      if (node.mMeshes[i] >= scene_.mNumMeshes) continue;
      if (auto ok = add_mesh(*scene_.mMeshes[node.mMeshes[i]], here); !ok) return ok;
    }
    for (std::size_t i = node.mNumChildren; i-- > 0;)
      nodes_.push_back({node.mChildren[i], here});
    return {};
  }

  Expected<void> add_mesh(const aiMesh& mesh, const Affine& here) {
    const bool has_material = mesh.mMaterialIndex < materials_.size();
    if (auto ok = mesh_.add_part(has_material ? materials_[mesh.mMaterialIndex] : std::string());
        !ok)
      return ok;
    const std::size_t first = mesh_.vertices();
    for (std::size_t i = 0; i < mesh.mNumVertices; ++i) {
      const aiVector3D& p = mesh.mVertices[i];
      if (auto ok = mesh_.add_vertex(here({p.x, p.y, p.z})); !ok) return ok;
    }
    if (mesh.HasTextureCoords(1)) ++further_sets_;
    count_opacities(mesh);
    std::vector<SceneCorner> corners;
    for (std::size_t f = 0; f < mesh.mNumFaces; ++f) {
      const std::span indices(mesh.mFaces[f].mIndices, mesh.mFaces[f].mNumIndices);
      if (std::ranges::any_of(indices, [&](unsigned i) { return i >= mesh.mNumVertices; }))
        return bad_input(
            "a face of the FBX refers to a vertex that its mesh does not have; export "
            "the file again");
      skipped_lines_ += indices.size() < 3 ? 1 : 0;
      if (indices.size() < 3) continue;
      corners.clear();
      for (const unsigned index : indices)
        corners.push_back(corner(mesh, index, first));
      if (auto ok = mesh_.add_face(corners, here.mirrors()); !ok) return ok;
    }
    return {};
  }

  void count_opacities(const aiMesh& mesh) {
    if (!mesh.HasVertexColors(0)) return;
    const std::span colours(mesh.mColors[0], mesh.mNumVertices);
    for (const aiColor4D& colour : colours)
      translucent_ += is_translucent(colour.a);
  }

  static SceneCorner corner(const aiMesh& mesh, unsigned index, std::size_t first) {
    SceneCorner out{.vertex = static_cast<std::uint32_t>(first + index)};
    if (mesh.HasTextureCoords(0))
      out.place = {mesh.mTextureCoords[0][index].x, mesh.mTextureCoords[0][index].y};
    if (mesh.HasVertexColors(0)) {
      const aiColor4D& colour = mesh.mColors[0][index];
      out.colour = {colour.r, colour.g, colour.b};
    }
    return out;
  }

  void report() {
    std::string names;
    for (const std::string& name : unread_)
      names += (names.empty() ? "" : ", ") + name;
    if (!names.empty())
      mesh_.note(counted(unread_.size(), "kind") + " of material maps not carried: " + names +
                 "; export GLB, whose maps of metalness, roughness and occlusion are read");
    const auto note = [&](std::uint64_t count, std::string_view noun, std::string_view rest) {
      if (count > 0) mesh_.note(counted(count, noun) + std::string(rest));
    };
    note(outline_.skins, "skin",
         " not carried: the mesh is shown as modelled; to show another pose, apply the skin before "
         "exporting");
    note(outline_.morphs, "morph controller", " not carried; apply the shape before exporting");
    note(outline_.animations, "animation",
         " not carried; to show another pose, export the mesh in that pose");
    note(further_sets_, "mesh",
         " with further sets of texture coordinates, not carried; bake the maps that use them into "
         "the first set");
    note(skipped_lines_, "point or line", " dropped; convert what you need to triangles");
  }

  const aiScene& scene_;
  const FbxOutline& outline_;
  SceneMesh mesh_;
  std::vector<std::string> materials_;  // names of the scene's materials, in order
  std::set<std::string> unread_;        // kinds of maps that are not kept
  std::vector<PlacedNode> nodes_;       // nodes that are still to be added
  std::uint64_t further_sets_ = 0, skipped_lines_ = 0, translucent_ = 0;
};

}  // namespace

bool is_fbx(std::span<const std::uint8_t> bytes) {
  return is_binary_fbx(bytes) || is_text_fbx(bytes);
}

std::string_view unit_of_fbx(std::span<const std::uint8_t> bytes) {
  const auto outline = outline_of_fbx(bytes);
  return outline ? length_in(*outline).unit : std::string_view();
}

Expected<RawMesh> read_fbx(std::span<const std::uint8_t> bytes, const ReadOptions& options) {
  const auto outline = outline_of_fbx(bytes);
  if (!outline) return tl::unexpected(outline.error());
  const auto imported = FbxScene::import(bytes);
  if (!imported) return tl::unexpected(imported.error());
  const aiScene& scene = imported->scene();
  const Companions companions = with_embedded_pictures(scene, options.beside);
  return FbxReader(scene, companions, *outline, options.limits).read();
}

}  // namespace vitrine::inline codec
