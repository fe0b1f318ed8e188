// SPDX-License-Identifier: Apache-2.0
#include "codec/gltf/gltf_scene.h"

#include <algorithm>
#include <string>
#include <utility>

#include "codec/gltf/gltf_document.h"
#include "codec/repair/raw_mesh.h"

namespace vitrine::inline codec {
namespace {

Expected<void> check_place(const Json& node, std::uint64_t index) {
  constexpr std::array<std::pair<const char*, std::size_t>, 4> kParts{
      {{"matrix", 16}, {"translation", 3}, {"rotation", 4}, {"scale", 3}}};
  for (const auto& [key, count] : kParts) {
    if (!node.contains(key) || are_numbers(member(node, key), count)) continue;
    return bad_gltf("the " + std::string(key) + " of node " + std::to_string(index) + " is not " +
                    std::to_string(count) + " numbers");
  }
  return {};
}

Affine transform_of(const Json& node) {
  if (const Json& matrix = member(node, "matrix"); matrix.is_array()) {
    const auto m =
        // `m` is in column-major order.
        numbers<16>(matrix, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
    return {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}, {m[12], m[13], m[14]}};
  }
  const auto t = numbers<3>(member(node, "translation"), {0, 0, 0});
  const auto q = numbers<4>(member(node, "rotation"), {0, 0, 0, 1});
  const auto s = numbers<3>(member(node, "scale"), {1, 1, 1});
  return compose({t[0], t[1], t[2]}, q, {s[0], s[1], s[2]});
}

struct Visit {
  std::uint64_t node;
  Affine parent;
  bool is_hidden = false;  // whether a node above hides this node
};

bool hides(const Json& node) {
  const Json& visible = member(extension(node, "KHR_node_visibility"), "visible");
  return visible.is_boolean() && !visible.get<bool>();
}

// Pushes the nodes in reverse order, so that the first node is popped first.
void push(const Json& nodes, const Affine& parent, std::vector<Visit>& open,
          bool is_hidden = false) {
  const auto first = static_cast<std::ptrdiff_t>(open.size());
  for (const Json& node : nodes) {
    open.push_back(
        {node.is_number_unsigned() ? node.get<std::uint64_t>() : kAbsent, parent, is_hidden});
  }
  std::reverse(open.begin() + first, open.end());
}

std::vector<MeshInstance> all_meshes(const Json& document) {
  const Json& meshes = member(document, "meshes");
  std::vector<MeshInstance> instances;
  for (std::uint64_t m = 0; meshes.is_array() && m < meshes.size(); ++m)
    instances.push_back({.mesh = m});
  return instances;
}

// Returns the first scene that shows a mesh. Each node is searched only once, even if it has
// several parents.
std::uint64_t scene_with_meshes(const Json& document) {
  const Json& nodes = member(document, "nodes");
  const Json& scenes = member(document, "scenes");
  std::vector<bool> seen(nodes.is_array() ? nodes.size() : 0, false);
  std::vector<Visit> open;
  for (std::uint64_t s = 0; s < scenes.size(); ++s) {
    push(member(scenes[s], "nodes"), Affine{}, open);
    while (!open.empty()) {
      const std::uint64_t node = open.back().node;
      open.pop_back();
      if (node >= seen.size() || seen[node]) continue;
      seen[node] = true;
      if (hides(nodes[node])) continue;
      if (whole(nodes[node], "mesh", kAbsent) != kAbsent) return s;
      push(member(nodes[node], "children"), Affine{}, open);
    }
  }
  return kAbsent;
}

Unexpected shows_none(std::uint64_t scene, const Json& document) {
  const std::string fault =
      "glTF: its default scene " + std::to_string(scene) + " shows none of the file's meshes";
  const std::uint64_t other = scene_with_meshes(document);
  const Json& nodes = member(document, "nodes");
  if (other == kAbsent && std::any_of(nodes.begin(), nodes.end(), hides))
    return bad_input(fault + ", because nodes are hidden; make them visible and export again");
  if (other == kAbsent) return bad_input(fault + "; export the scene with them");
  return bad_input(fault + ", but scene " + std::to_string(other) +
                   " does; make that the default and export again");
}

// Returns for each node whether it belongs to a scene, also as one of the lower levels of detail of
// MSFT_lod.
std::vector<bool> nodes_in_scenes(const Json& document) {
  const Json& nodes = member(document, "nodes");
  std::vector<bool> seen(nodes.is_array() ? nodes.size() : 0, false);
  std::vector<Visit> open;
  for (const Json& scene : member(document, "scenes"))
    push(member(scene, "nodes"), Affine{}, open);
  while (!open.empty()) {
    const std::uint64_t node = open.back().node;
    open.pop_back();
    if (node >= seen.size() || seen[node]) continue;
    seen[node] = true;
    push(member(nodes[node], "children"), Affine{}, open);
    push(member(extension(nodes[node], "MSFT_lod"), "ids"), Affine{}, open);
  }
  return seen;
}

// Counts the meshes of nodes outside all scenes, and the meshes that no node has.
std::uint64_t meshes_outside_scenes(const Json& document) {
  if (!element(document, "scenes", whole(document, "scene", 0)).is_object()) return 0;
  const Json& nodes = member(document, "nodes");
  const std::vector<bool> in_scene = nodes_in_scenes(document);
  std::vector<bool> has_node(member(document, "meshes").size(), false);
  std::uint64_t outside = 0;
  for (std::size_t n = 0; n < in_scene.size(); ++n) {
    const std::uint64_t mesh = whole(nodes[n], "mesh", kAbsent);
    if (mesh >= has_node.size()) continue;
    has_node[mesh] = true;
    outside += !in_scene[n];
  }
  return outside + static_cast<std::uint64_t>(std::ranges::count(has_node, false));
}

}  // namespace

Expected<GltfScene> read_scene(const Json& document) {
  const std::uint64_t number = whole(document, "scene", 0);
  const Json& scene = element(document, "scenes", number);
  if (!scene.is_object()) return GltfScene{all_meshes(document), {}};
  const Json& nodes = member(document, "nodes");
  std::vector<bool> seen(nodes.is_array() ? nodes.size() : 0, false);
  GltfScene out;
  if (!member(document, "skins").empty()) out.places.resize(seen.size());
  std::vector<Visit> open;
  push(member(scene, "nodes"), Affine{}, open);
  while (!open.empty()) {
    const Visit visit = open.back();
    open.pop_back();
    if (visit.node >= seen.size()) return bad_gltf("a node does not exist");
    if (seen[visit.node])
      return bad_gltf("node " + std::to_string(visit.node) + " has two parents");
    seen[visit.node] = true;
    const Json& node = nodes[visit.node];
    if (auto ok = check_place(node, visit.node); !ok) return tl::unexpected(ok.error());
    const Affine place = visit.parent * transform_of(node);
    const bool is_hidden = visit.is_hidden || hides(node);
    if (const auto mesh = whole(node, "mesh", kAbsent); mesh != kAbsent && !is_hidden)
      out.meshes.push_back({mesh, visit.node, place});
    if (!out.places.empty()) out.places[visit.node] = place;
    push(member(node, "children"), place, open, is_hidden);
  }
  if (out.meshes.empty() && !member(document, "meshes").empty())
    return shows_none(number, document);
  return out;
}

std::vector<std::string> report_scene(const Json& document) {
  std::vector<std::string> lines;
  const Json& nodes = member(document, "nodes");
  const auto hidden = static_cast<std::uint64_t>(std::count_if(nodes.begin(), nodes.end(), hides));
  if (hidden > 0)
    lines.push_back(counted(hidden, "hidden node") +
                    " and the nodes below not carried; make them visible and export again");
  const std::size_t scenes = member(document, "scenes").size();
  if (scenes > 1)
    lines.push_back(counted(scenes - 1, "scene") +
                    " besides the default one not carried; export each scene as its own file");
  if (const std::uint64_t outside = meshes_outside_scenes(document); outside > 0)
    lines.push_back(counted(outside, "use") +
                    " of a mesh outside all scenes not carried; add it to the scene and export "
                    "again");
  const std::size_t variants =
      member(extension(document, "KHR_materials_variants"), "variants").size();
  if (variants > 0)
    lines.push_back(counted(variants, "material variant") +
                    " not carried, only the default materials; export each variant as its own "
                    "file");
  return lines;
}

}  // namespace vitrine::inline codec
