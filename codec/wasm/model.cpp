// SPDX-License-Identifier: Apache-2.0
#include "codec/wasm/model.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "codec/core/fill_in.h"
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

Vec3 box_centre(const Segments<Vec3i>& positions) {
  LatticeBox box = LatticeBox::none();
  for (std::size_t i = 0; i < positions.size(); ++i)
    box.add({positions[i], positions[i]});
  return (to_vec3(box.low) + to_vec3(box.high)) * 0.5;
}

std::array<float, 3> to_floats(const Vec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

Expected<void> check(std::string_view what, std::span<const std::uint8_t> bytes,
                     const Sha256& expected) {
  if (sha256(bytes) == expected) return {};
  return fail(ErrorCode::kBadInput, join({what, " does not match its SHA-256; fetch it again"}));
}

std::int16_t to_snorm(double value) {
  return static_cast<std::int16_t>(std::clamp(value, -1.0, 1.0) * 32767);
}

}  // namespace

Model::Model(std::shared_ptr<const Manifest> manifest) : manifest_(std::move(manifest)) {}

Expected<std::unique_ptr<Model>> Model::open(std::span<const std::uint8_t> header) {
  auto manifest = parse_header(header, kBrowserLimits);
  if (!manifest) return Unexpected(std::move(manifest.error()));
  return std::make_unique<Model>(std::make_shared<const Manifest>(std::move(*manifest)));
}

Expected<void> Model::check_base(std::span<const std::uint8_t> bytes) const {
  return check("the base mesh", bytes, manifest_->base_sha256);
}

Expected<void> Model::check_chunk(std::size_t chunk, std::span<const std::uint8_t> bytes) const {
  if (chunk >= manifest_->chunks.size())
    return fail(ErrorCode::kState,
                "there is no such chunk; the manifest lists those that there are");
  const ChunkInfo& info = manifest_->chunks[chunk];
  return check(fill_in("the chunk of level {}, region {}", {info.level, info.region}), bytes,
               info.sha256);
}

Expected<void> Model::start(BaseMesh base) {
  base_ = std::move(base);
  if (auto started = restart(); !started) return started;
  centre_ =
      box_centre(refiner_->positions());  // the base itself counts in cells of its own lattice
  return {};
}

Expected<void> Model::restart() {
  auto refiner = Refiner::start(manifest_, base_);
  if (!refiner) return Unexpected(std::move(refiner.error()));
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
  if (!refiner_)
    return fail(ErrorCode::kState, "the base mesh must come first; give it before the chunks");
  most_triangles_ = std::numeric_limits<double>::infinity();
  return pursue(goal, trimmed_ || exceeds(goal));
}

// A camera never asks for less, for what it has left behind may come into sight again, unless more
// is held than there is room for.
Expected<bool> Model::want(const View& view, double most_triangles) {
  if (!refiner_)
    return fail(ErrorCode::kState, "the base mesh must come first; give it before the chunks");
  most_triangles_ = most_triangles;
  const bool crowded = bytes_held() > view.bytes || refiner_->face_count() > most_triangles;
  return pursue(view, trimmed_ || crowded);
}

Expected<bool> Model::pursue(const Want& goal, bool back) {
  if (back) {
    if (auto done = restart(); !done) return Unexpected(std::move(done.error()));
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

bool Model::exceeds(const Want& goal) const {
  Planner plan(*manifest_);
  plan.want(goal);
  std::vector<std::uint8_t> wanted(applied_.size());
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
  if (static_cast<double>(planner_->faces_held()) > most_triangles_) planner_.reset();
  return planner_ ? static_cast<int>(*chunk) : -1;
}

Expected<void> Model::apply(std::size_t chunk, std::span<const std::uint8_t> bytes) {
  if (!refiner_ || trimmed_)
    return fail(ErrorCode::kState, "the base mesh must come first; give it before the chunks");
  if (chunk >= applied_.size())
    return fail(ErrorCode::kState,
                "there is no such chunk; the manifest lists those that there are");
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
  shown_ = {};
  vertices_out_ = faces_out_ = 0;
  for (VertexId v = 0; v < refiner_->vertex_count(); ++v)
    shown_.push_back(to_floats(refiner_->display_position(v) - centre_));
}

std::uint32_t Model::next_vertices() {
  const auto end =
      static_cast<VertexId>(std::min<std::size_t>(shown_.size(), vertices_out_ + kPiece));
  const std::uint32_t count = end - vertices_out_;
  positions_.clear();
  normals_.clear();
  colours_.clear();
  lattice_positions_.clear();
  for (; vertices_out_ < end; ++vertices_out_)
    add_vertex(vertices_out_);
  if (count == 0) shown_ = {}, vertices_out_ = 0;
  return count;
}

void Model::add_vertex(VertexId v) {
  positions_.push_back(to_floats(shown(v) * manifest_->lattice.step));
  const Vec3 n = normal(v);
  normals_.push_back({to_snorm(n.x), to_snorm(n.y), to_snorm(n.z), 0});
  lattice_positions_.push_back(refiner_->positions()[v]);
  if (!refiner_->colours().empty()) colours_.push_back(from_ycocg(refiner_->colours()[v]));
}

Vec3 Model::shown(VertexId v) const {
  const auto& [x, y, z] = shown_[v];
  return {x, y, z};
}

Vec3 Model::normal(VertexId v) const {
  const Connectivity& mesh = refiner_->connectivity();
  const Vec3 origin = shown(v);
  const Corner first = mesh.corner_at(v);
  Vec3 sum;
  Corner c = first;
  do {
    const VertexId a = mesh.neighbour(c), b = mesh.vertex(prev(c));
    if (!is_virtual(a) && !is_virtual(b)) sum += cross(shown(a) - origin, shown(b) - origin);
    c = mesh.swing(c);
  } while (c != first);
  const double size = length(sum);
  return size > 0 ? sum * (1 / size) : Vec3{0, 0, 1};
}

std::uint32_t Model::next_faces() {
  const Connectivity& mesh = refiner_->connectivity();
  faces_.clear();
  for (; faces_out_ < mesh.face_count() && faces_.size() < kPiece; ++faces_out_) {
    const Corner c = 3 * faces_out_;
    if (mesh.is_real(faces_out_))
      faces_.push_back({mesh.vertex(c), mesh.vertex(c + 1), mesh.vertex(c + 2)});
  }
  return static_cast<std::uint32_t>(faces_.size());
}

const std::vector<double>& Model::summary() {
  const Manifest& m = *manifest_;
  const auto number = [](auto value) { return static_cast<double>(value); };
  const Vec3 centre = m.lattice.origin + centre_ * m.lattice.step;
  summary_.clear();
  const auto add = [&](std::initializer_list<double> numbers) {
    for (const double value : numbers)
      summary_.push_back(value);
  };
  add({number(m.levels.size()), number(m.chunks.size()), number(m.base_offset),
       number(m.base_length), number(m.file_bytes), number(m.coloured), number(m.lattice.bits),
       m.lattice.step, centre.x, centre.y, centre.z});
  for (std::uint32_t i = 0; i < m.levels.size(); ++i) {
    const LevelInfo& level = m.levels[i];
    add({number(level.vertices), number(level.faces), level.max_error, level.rms_error,
         number(m.cumulative_bytes(i))});
  }
  for (const ChunkInfo& chunk : m.chunks) {
    add({number(chunk.level), number(chunk.region), number(chunk.offset), number(chunk.length)});
  }
  return summary_;
}

}  // namespace vitrine
