// SPDX-License-Identifier: Apache-2.0
#include "codec/import/scene_mesh.h"

#include <algorithm>
#include <cmath>

namespace vitrine::inline codec {

SceneMesh::SceneMesh(std::string_view format, const Companions& companions, const Limits& limits,
                     std::uint64_t room)
    : materials_(companions, limits), room_(std::min(room, limits.vertices)) {
  mesh_.format = format;
  // DAE and FBX files repeat positions where normals or texture coordinates are discontinuous.
  mesh_.has_seams = true;
}

Unexpected SceneMesh::too_many() const {
  return fail(ErrorCode::kLimit, "the " + std::string(mesh_.format) +
                                     "'s instances make too many vertices or faces; export the "
                                     "mesh without instances");
}

Expected<void> SceneMesh::add_part(std::string_view material) {
  if (++parts_ > room_) return too_many();
  mesh_.use_material(materials_.use(material));
  return {};
}

Expected<void> SceneMesh::add_vertex(const Vec3& position) {
  if (mesh_.positions.size() >= room_) return too_many();
  mesh_.positions.push_back(position);
  return {};
}

Expected<void> SceneMesh::add_face(std::span<SceneCorner> corners, bool is_mirrored) {
  all_corners_ += corners.size();
  if (all_corners_ > room_ || mesh_.face_count() >= room_) return too_many();
  if (is_mirrored) std::ranges::reverse(corners);
  corners_.clear();
  at_corners_.clear();
  for (const SceneCorner& corner : corners) {
    corners_.push_back(corner.vertex);
    if (materials_.has_maps())
      at_corners_.push_back(from_upwards(corner.place[0], corner.place[1]));
    if (corner.vertex >= mesh_.positions.size()) continue;
    const auto& [r, g, b] = corner.colour;
    if (!std::isnan(r)) {
      own_.resize(mesh_.positions.size());
      own_.add(corner.vertex, to_linear({to_byte(r), to_byte(g), to_byte(b)}));
    } else if (materials_.has_current()) {
      baked_.resize(mesh_.positions.size());
      baked_.add(corner.vertex, materials_.colour_at(corner.place[0], corner.place[1]));
    }
  }
  mesh_.add_face(corners_, 0, at_corners_);
  return {};
}

void SceneMesh::take_colours() {
  if (!own_.empty()) {
    own_.resize(mesh_.positions.size());
    mesh_.attributes.colours = own_.take();
    if (!baked_.empty() && materials_.are_plain())
      mesh_.repairs.push_back(counted(materials_.used(), "material") +
                              " not carried: the vertices have colours of their own; remove these "
                              "to use the materials");
  } else if (!baked_.empty()) {
    baked_.resize(mesh_.positions.size());
    mesh_.attributes.colours = baked_.take();
    mesh_.is_baked = true;
    mesh_.repairs = materials_.report_baked();
  }
}

RawMesh SceneMesh::finish() && {
  take_colours();
  const auto unread = materials_.report_unread();
  mesh_.repairs.insert(mesh_.repairs.end(), unread.begin(), unread.end());
  mesh_.repairs.insert(mesh_.repairs.end(), notes_.begin(), notes_.end());
  materials_.give_to(mesh_);
  return std::move(mesh_);
}

Affine to_y_up(int up_axis, double scale) {
  Affine turn;
  if (up_axis == 0) turn = {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}, {}};
  if (up_axis == 2) turn = {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}, {}};
  return {turn.x * scale, turn.y * scale, turn.z * scale, {}};
}

}  // namespace vitrine::inline codec
