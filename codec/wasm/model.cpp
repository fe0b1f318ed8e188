// SPDX-License-Identifier: Apache-2.0
#include "codec/wasm/model.h"

#include <algorithm>
#include <utility>

#include "codec/progressive/colour.h"

namespace vitrine {
namespace {

// What fits the 4 GiB of a WebAssembly memory.
constexpr Limits kBrowserLimits = {.vertices = 16'000'000, .faces = 32'000'000};

std::uint64_t whole(double value) {
  return static_cast<std::uint64_t>(std::clamp(value, 0.0, 9007199254740992.0));
}

Want to_want(std::uint32_t kind, double value) {
  if (!(value >= 0)) value = 0;
  switch (kind) {
    case 0:
      return WantTriangles{whole(value)};
    case 1:
      return WantBytes{whole(value)};
    case 2:
      return WantError{value};
    default:
      return WantLevel{static_cast<std::uint32_t>(std::min(value, 4294967295.0))};
  }
}

Vec3 box_centre(std::span<const Vec3i> positions) {
  if (positions.empty()) return {};
  Vec3i low = positions[0], high = positions[0];
  for (const Vec3i& p : positions) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  return (to_vec3(low) + to_vec3(high)) * 0.5;
}

Expected<void> check(const std::string& what, std::span<const std::uint8_t> bytes,
                     const Sha256& expected) {
  if (sha256(bytes) == expected) return {};
  return fail(ErrorCode::kBadInput, what + " does not match its SHA-256: fetch it again");
}

std::int16_t to_snorm(double value) {
  return static_cast<std::int16_t>(std::clamp(value, -1.0, 1.0) * 32767);
}

}  // namespace

Expected<Model> Model::open(std::span<const std::uint8_t> header) {
  auto manifest = parse_header(header, kBrowserLimits);
  if (!manifest) return Unexpected(manifest.error());
  Model model;
  model.manifest_ = std::make_unique<Manifest>(std::move(*manifest));
  return model;
}

Expected<void> Model::check_base(std::span<const std::uint8_t> bytes) const {
  return check("the base mesh", bytes, manifest_->base_sha256);
}

Expected<void> Model::check_chunk(std::size_t chunk, std::span<const std::uint8_t> bytes) const {
  if (chunk >= manifest_->chunks.size()) return fail(ErrorCode::kState, "there is no such chunk");
  const ChunkInfo& info = manifest_->chunks[chunk];
  return check("the chunk of level " + std::to_string(info.level) + ", region " +
                   std::to_string(info.region),
               bytes, info.sha256);
}

Expected<void> Model::start(BaseMesh base) {
  base_ = std::move(base);
  if (auto started = restart(); !started) return started;
  centre_ =
      box_centre(refiner_->positions());  // the base itself counts in cells of its own lattice
  return {};
}

Expected<void> Model::restart() {
  auto refiner = Refiner::start(*manifest_, base_);
  if (!refiner) return Unexpected(refiner.error());
  refiner_ = std::move(*refiner);
  applied_.assign(manifest_->chunks.size(), false);
  planner_.emplace(*manifest_);
  planner_->want(WantLevel{0});
  trimmed_ = false;
  return {};
}

Expected<bool> Model::want(std::uint32_t kind, double value) {
  return want(to_want(kind, value));
}

Expected<bool> Model::want(const Want& goal) {
  if (!refiner_) return fail(ErrorCode::kState, "the base mesh must come first");
  const bool back = trimmed_ || exceeds(goal);
  if (back) {
    if (auto done = restart(); !done) return Unexpected(done.error());
  }
  planner_.emplace(*manifest_);
  planner_->want(goal);
  triangles_.reset();
  if (const auto* w = std::get_if<WantTriangles>(&goal)) {
    triangles_ = static_cast<std::uint32_t>(std::min<std::uint64_t>(w->triangles, 0xFFFF'FFFFu));
  }
  for (std::size_t i = 0; i < applied_.size(); ++i) {
    if (applied_[i]) planner_->have(i);
  }
  return back;
}

// A camera never asks for less: what it has left behind may come into sight again.
bool Model::exceeds(const Want& goal) const {
  if (std::holds_alternative<View>(goal)) return false;
  Planner plan(*manifest_);
  plan.want(goal);
  std::vector<bool> wanted(applied_.size());
  while (const auto chunk = plan.next()) {
    wanted[*chunk] = true;
    plan.have(*chunk);
  }
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (applied_[i] && !wanted[i]) return true;
  }
  return false;
}

int Model::next_chunk() {
  if (!planner_) return -1;
  const auto chunk = planner_->next();
  if (!chunk) return -1;
  planner_->have(*chunk);
  return static_cast<int>(*chunk);
}

Expected<void> Model::apply(std::size_t chunk, std::span<const std::uint8_t> bytes) {
  if (!refiner_ || trimmed_) return fail(ErrorCode::kState, "the base mesh must come first");
  if (chunk >= applied_.size()) return fail(ErrorCode::kState, "there is no such chunk");
  auto done = refiner_->apply(chunk, bytes);
  applied_[chunk] = done.has_value();
  trimmed_ = !done;
  return done;
}

void Model::trim() {
  if (!refiner_ || trimmed_ || !triangles_) return;
  const std::uint32_t before = refiner_->face_count();
  refiner_->undo_to_faces(*triangles_);
  trimmed_ = refiner_->face_count() != before;
}

double Model::bytes_held() const {
  double bytes = static_cast<double>(manifest_->head_bytes());
  for (std::size_t i = 0; i < applied_.size(); ++i) {
    if (applied_[i]) bytes += static_cast<double>(manifest_->chunks[i].length);
  }
  return bytes;
}

void Model::display() {
  std::vector<Vec3> displayed;
  refiner_->display_positions(displayed);
  fill_positions(displayed);
  fill_indices();
  fill_normals(displayed);
  fill_colours();
}

void Model::fill_positions(const std::vector<Vec3>& displayed) {
  positions_.resize(3 * displayed.size());
  for (std::size_t i = 0; i < displayed.size(); ++i) {
    const Vec3 p = (displayed[i] - centre_) * manifest_->lattice.step;
    positions_[3 * i] = static_cast<float>(p.x);
    positions_[3 * i + 1] = static_cast<float>(p.y);
    positions_[3 * i + 2] = static_cast<float>(p.z);
  }
}

void Model::fill_indices() {
  const Connectivity& mesh = refiner_->connectivity();
  indices_.clear();
  indices_.reserve(3 * std::size_t{refiner_->face_count()});
  for (std::uint32_t face = 0; face < mesh.face_count(); ++face) {
    if (mesh.is_dead(face) || !mesh.is_real(face)) continue;
    for (Corner c = 3 * face; c < 3 * face + 3; ++c)
      indices_.push_back(mesh.vertex(c));
  }
}

void Model::fill_colours() {
  const auto colours = refiner_->colours();
  colours_.resize(colours.size());
  std::transform(colours.begin(), colours.end(), colours_.begin(), from_ycocg);
}

void Model::fill_normals(const std::vector<Vec3>& displayed) {
  std::vector<Vec3> sums(displayed.size());
  for (std::size_t i = 0; i < indices_.size(); i += 3) {
    const Vec3& a = displayed[indices_[i]];
    const Vec3 normal = cross(displayed[indices_[i + 1]] - a, displayed[indices_[i + 2]] - a);
    for (std::size_t k = 0; k < 3; ++k)
      sums[indices_[i + k]] += normal;
  }
  normals_.assign(4 * sums.size(), 0);
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const double size = length(sums[i]);
    const Vec3 unit = size > 0 ? sums[i] * (1 / size) : Vec3{0, 0, 1};
    normals_[4 * i] = to_snorm(unit.x);
    normals_[4 * i + 1] = to_snorm(unit.y);
    normals_[4 * i + 2] = to_snorm(unit.z);
  }
}

const std::vector<double>& Model::summary() {
  const Manifest& m = *manifest_;
  const auto number = [](auto value) { return static_cast<double>(value); };
  const Vec3 centre = m.lattice.origin + centre_ * m.lattice.step;
  summary_ = {number(m.levels.size()),
              number(m.chunks.size()),
              number(m.base_offset),
              number(m.base_length),
              number(m.file_bytes),
              number(m.coloured),
              number(m.lattice.bits),
              m.lattice.step,
              centre.x,
              centre.y,
              centre.z};
  for (std::uint32_t i = 0; i < m.levels.size(); ++i) {
    const LevelInfo& level = m.levels[i];
    summary_.insert(summary_.end(), {number(level.vertices), number(level.faces), level.max_error,
                                     level.rms_error, number(m.cumulative_bytes(i))});
  }
  for (const ChunkInfo& chunk : m.chunks) {
    summary_.insert(summary_.end(), {number(chunk.level), number(chunk.region),
                                     number(chunk.offset), number(chunk.length)});
  }
  return summary_;
}

}  // namespace vitrine
