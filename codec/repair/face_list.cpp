// SPDX-License-Identifier: Apache-2.0
#include "codec/repair/face_list.h"

#include <algorithm>

#include "codec/repair/triangulate.h"

namespace vitrine::inline codec {

void FaceList::add(std::span<const std::uint32_t> corners,
                   std::span<const TextureCoordinates> at_corners) {
  if (corners.size() > 3) return add_polygon(corners, at_corners);
  add({corners[0], corners[1], corners[2]});
  if (at_corners.empty()) return;
  coordinates.resize(triangles.size());
  std::copy_n(at_corners.begin(), 3, coordinates.back().begin());
}

void FaceList::add_polygon(std::span<const std::uint32_t> corners,
                           std::span<const TextureCoordinates> at_corners) {
  if (!at_corners.empty()) polygon_coordinates_.resize(polygon_corners_.size());
  polygon_corners_.insert(polygon_corners_.end(), corners.begin(), corners.end());
  polygon_ends_.push_back(polygon_corners_.size());
  polygon_coordinates_.insert(polygon_coordinates_.end(), at_corners.begin(), at_corners.end());
}

void FaceList::use_material(std::uint16_t material) {
  if (material == (runs_.empty() ? 0 : runs_.back().material)) return;
  const MaterialRun run{triangles.size(), polygon_ends_.size(), material};
  const bool replaces = !runs_.empty() && runs_.back().triangle == run.triangle &&
                        runs_.back().polygon == run.polygon;
  if (replaces) {
    runs_.back() = run;
    return;
  }
  // Grows the capacity by an eighth only: if every face began a new run, doubling would take more
  // memory than all vertices.
  if (runs_.size() == runs_.capacity()) runs_.reserve(runs_.size() + runs_.size() / 8 + 4);
  runs_.push_back(run);
}

void FaceList::drop_texturing() {
  coordinates = {};
  polygon_coordinates_ = {};
  runs_ = {};
}

void FaceList::reserve_for_polygons() {
  const std::size_t count = triangles.size() + polygon_corners_.size() - 2 * polygon_ends_.size();
  triangles.reserve(count);
  if (coordinates.empty() && polygon_coordinates_.empty()) return;
  polygon_coordinates_.resize(polygon_corners_.size());
  coordinates.reserve(count);
  coordinates.resize(triangles.size());
}

void FaceList::cut_polygons(std::span<const Vec3> positions) {
  if (!runs_.empty()) materials_ = expanded_runs();
  runs_ = {};
  reserve_for_polygons();
  const std::span<const std::uint32_t> all = polygon_corners_;
  std::vector<Triangle> parts;
  std::size_t begin = 0;
  for (const std::size_t end : polygon_ends_) {
    const auto corners = all.subspan(begin, end - begin);
    parts.clear();
    parts.reserve(corners.size() - 2);
    triangulate(positions, corners, parts);
    for (const auto& [a, b, c] : parts) {
      triangles.push_back({corners[a], corners[b], corners[c]});
      if (polygon_coordinates_.empty()) continue;
      const TextureCoordinates* at = &polygon_coordinates_[begin];
      coordinates.push_back({at[a], at[b], at[c]});
    }
    begin = end;
  }
  polygon_corners_ = {};
  polygon_coordinates_ = {};
  polygon_ends_ = {};
}

std::vector<std::uint16_t> FaceList::expanded_runs() const {
  std::vector<std::uint16_t> materials;
  materials.reserve(triangles.size() + polygon_corners_.size() - 2 * polygon_ends_.size());
  std::uint16_t current = 0;
  for (const MaterialRun& run : runs_) {
    materials.resize(run.triangle, current);
    current = run.material;
  }
  materials.resize(triangles.size(), current);
  current = 0;
  auto run = runs_.begin();
  std::size_t begin = 0;
  for (std::size_t p = 0; p < polygon_ends_.size(); ++p) {
    for (; run != runs_.end() && run->polygon <= p; ++run)
      current = run->material;
    materials.insert(materials.end(), polygon_ends_[p] - begin - 2, current);
    begin = polygon_ends_[p];
  }
  return materials;
}

std::vector<std::uint16_t> FaceList::take_materials() {
  materials_.resize(triangles.size());
  return std::move(materials_);
}

}  // namespace vitrine::inline codec
