// SPDX-License-Identifier: Apache-2.0
#include "codec/plan/planner.h"

#include "codec/plan/view_plan.h"

namespace vitrine::inline codec {

Planner::Planner(const Manifest& manifest)
    : manifest_(&manifest),
      want_(WantLevel{0}),
      have_(manifest.chunks.size(), false),
      bytes_(manifest.head_bytes()),
      faces_(manifest.levels[0].faces) {}

void Planner::want(const Want& want) {
  want_ = want;
}

void Planner::have(std::size_t chunk) {
  if (chunk >= have_.size() || have_[chunk]) return;
  have_[chunk] = true;
  while (first_missing_ < have_.size() && have_[first_missing_])
    ++first_missing_;
  const ChunkInfo& info = manifest_->chunks[chunk];
  bytes_ += info.length;
  // The exact number of faces is unknown: a split adds two faces, or one at a boundary, and a
  // component insertion adds any number. The estimate uses the level's average number of faces per
  // new vertex. The estimate is exact once all chunks of the level are present.
  const double added = static_cast<double>(info.splits) + info.inserted;
  faces_ += added * faces_per_vertex(info.level);
}

std::uint64_t Planner::faces_held() const {
  return static_cast<std::uint64_t>(faces_ + 0.5);
}

double Planner::faces_per_vertex(std::uint32_t level) const {
  const LevelInfo &fine = manifest_->levels[level], &coarse = manifest_->levels[level - 1];
  const double added = static_cast<double>(fine.vertices - coarse.vertices);
  return added > 0 ? (static_cast<double>(fine.faces) - static_cast<double>(coarse.faces)) / added
                   : 0.0;
}

std::optional<std::size_t> Planner::next() const {
  if (const auto* view = std::get_if<View>(&want_)) {
    return ViewPlan(*manifest_, have_, *view).best(view->bytes - static_cast<double>(bytes_held()));
  }
  // Chunks are in order of levels in the file, so the first missing chunk can always be applied.
  const bool wanted = first_missing_ < have_.size() && is_wanted(first_missing_);
  return wanted ? std::optional(first_missing_) : std::nullopt;
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

}  // namespace vitrine::inline codec
