// SPDX-License-Identifier: Apache-2.0
#include "codec/progressive/planner.h"

#include "codec/progressive/view_plan.h"

namespace vitrine {

Planner::Planner(const Manifest& manifest)
    : manifest_(&manifest), want_(WantLevel{0}), have_(manifest.chunks.size(), false) {}

void Planner::want(const Want& want) {
  want_ = want;
}

void Planner::have(std::size_t chunk) {
  if (chunk < have_.size()) have_[chunk] = true;
}

std::uint64_t Planner::bytes_held() const {
  std::uint64_t bytes = manifest_->head_bytes();
  for (std::size_t i = 0; i < have_.size(); ++i) {
    if (have_[i]) bytes += manifest_->chunks[i].length;
  }
  return bytes;
}

std::uint64_t Planner::faces_held() const {
  // A split adds two faces, or one at a boundary, and what is born whole has its own number; a
  // level's average is exact once it is whole.
  double faces = manifest_->levels[0].faces;
  for (std::size_t i = 0; i < have_.size(); ++i) {
    if (!have_[i]) continue;
    const ChunkInfo& chunk = manifest_->chunks[i];
    const double born = static_cast<double>(chunk.splits) + chunk.newborn;
    faces += born * faces_per_vertex(chunk.level);
  }
  return static_cast<std::uint64_t>(faces + 0.5);
}

double Planner::faces_per_vertex(std::uint32_t level) const {
  const LevelInfo &fine = manifest_->levels[level], &coarse = manifest_->levels[level - 1];
  const double born = static_cast<double>(fine.vertices - coarse.vertices);
  return born > 0 ? (static_cast<double>(fine.faces) - static_cast<double>(coarse.faces)) / born
                  : 0.0;
}

std::optional<std::size_t> Planner::next() const {
  if (const auto* view = std::get_if<View>(&want_)) {
    return ViewPlan(*manifest_, have_, *view).best(view->bytes - static_cast<double>(bytes_held()));
  }
  // File order is level order, so the first chunk not held is always ready.
  for (std::size_t i = 0; i < have_.size(); ++i) {
    if (!have_[i]) return is_wanted(i) ? std::optional(i) : std::nullopt;
  }
  return std::nullopt;
}

bool Planner::is_wanted(std::size_t chunk) const {
  const ChunkInfo& info = manifest_->chunks[chunk];
  if (const auto* w = std::get_if<WantTriangles>(&want_)) return faces_held() < w->triangles;
  if (const auto* w = std::get_if<WantBytes>(&want_)) {
    return bytes_held() + info.length <= w->bytes;
  }
  if (const auto* w = std::get_if<WantError>(&want_)) {
    return manifest_->levels[info.level - 1].max_error > w->error;
  }
  return info.level <= std::get<WantLevel>(want_).level;
}

}  // namespace vitrine
