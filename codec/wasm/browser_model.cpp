// SPDX-License-Identifier: Apache-2.0
#include "codec/wasm/browser_model.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "codec/coding/atlas_coder.h"
#include "codec/core/fill_in.h"

namespace vitrine::inline codec {
namespace {

// Limits for which a WebAssembly memory of 4 GiB suffices.
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

std::uint32_t semantic_bits(const PerSemantic<Semantic>& semantics) {
  std::uint32_t bits = 0;
  for (const Semantic semantic : semantics)
    bits |= 1u << static_cast<unsigned>(semantic);
  return bits;
}

std::int16_t to_snorm(double value) {
  return static_cast<std::int16_t>(std::clamp(value, -1.0, 1.0) * 32767);
}

}  // namespace

BrowserModel::BrowserModel(std::shared_ptr<const Manifest> manifest)
    : manifest_(std::move(manifest)) {}

Expected<std::unique_ptr<BrowserModel>> BrowserModel::open(std::span<const std::uint8_t> header) {
  auto manifest = parse_header(header, kBrowserLimits);
  if (!manifest) return tl::unexpected(manifest.error());
  return std::make_unique<BrowserModel>(std::make_shared<const Manifest>(std::move(*manifest)));
}

Expected<void> BrowserModel::check_base(std::span<const std::uint8_t> bytes) const {
  return check("the base mesh", bytes, manifest_->base_sha256);
}

Expected<void> BrowserModel::check_atlas(std::span<const std::uint8_t> bytes) const {
  return check("the atlas", bytes, manifest_->texture.atlas_sha256);
}

Expected<void> BrowserModel::check_picture(std::size_t picture,
                                           std::span<const std::uint8_t> bytes) const {
  const auto& pictures = manifest_->texture.pictures;
  if (picture >= pictures.size())
    return fail(ErrorCode::kState,
                "there is no such picture; the manifest lists those that there are");
  return check(fill_in("picture {}", {picture}), bytes, pictures[picture].sha256);
}

Expected<void> BrowserModel::check_chunk(std::size_t chunk,
                                         std::span<const std::uint8_t> bytes) const {
  if (chunk >= manifest_->chunks.size())
    return fail(ErrorCode::kState,
                "there is no such chunk; the manifest lists those that there are");
  const ChunkInfo& info = manifest_->chunks[chunk];
  return check(fill_in("the chunk of level {}, region {}", {info.level, info.region}), bytes,
               info.sha256);
}

Expected<void> BrowserModel::start(BaseMesh base, std::span<const std::uint8_t> atlas) {
  if (!manifest_->texture.empty()) {
    auto decoded = decode_atlas(atlas, base);
    if (!decoded) return tl::unexpected(decoded.error());
    base.atlas = std::move(*decoded);
  }
  base_ = std::move(base);
  if (auto started = restart(); !started) return started;
  // Uses the refiner's positions, because those in `base_` are cell numbers instead of lattice
  // units.
  centre_ = box_centre(refiner_->positions());
  return {};
}

Expected<void> BrowserModel::restart() {
  auto refiner = Refiner::start(manifest_, base_);
  if (!refiner) return tl::unexpected(refiner.error());
  refiner_ = std::move(*refiner);
  applied_.assign(manifest_->chunks.size(), false);
  planner_.emplace(*manifest_);
  planner_->want(WantLevel{0});
  needs_restart_ = false;
  return {};
}

Expected<bool> BrowserModel::want(std::uint32_t kind, double value) {
  return want(to_want(kind, value));
}

Expected<bool> BrowserModel::want(const Want& goal) {
  if (!refiner_)
    return fail(ErrorCode::kState, "the base mesh must come first; give it before the chunks");
  most_triangles_ = std::numeric_limits<double>::infinity();
  return pursue(goal, needs_restart_ || exceeds(goal));
}

// A view never reduces detail, because regions that left the view may become visible again.
// Restarts only if a restart is pending or the model exceeds the limits.
Expected<bool> BrowserModel::want(const View& view, double most_triangles) {
  if (!refiner_)
    return fail(ErrorCode::kState, "the base mesh must come first; give it before the chunks");
  most_triangles_ = most_triangles;
  const bool crowded = bytes_held() > view.bytes || refiner_->face_count() > most_triangles;
  return pursue(view, needs_restart_ || crowded);
}

Expected<bool> BrowserModel::pursue(const Want& goal, bool back) {
  if (back) {
    if (auto done = restart(); !done) return tl::unexpected(done.error());
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

bool BrowserModel::exceeds(const Want& goal) const {
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

int BrowserModel::next_chunk() {
  if (!planner_) return -1;
  const auto chunk = planner_->next();
  if (!chunk) return -1;
  planner_->have(*chunk);
  if (static_cast<double>(planner_->faces_held()) > most_triangles_) planner_.reset();
  return planner_ ? static_cast<int>(*chunk) : -1;
}

Expected<void> BrowserModel::apply(std::size_t chunk, std::span<const std::uint8_t> bytes) {
  if (!refiner_ || needs_restart_)
    return fail(ErrorCode::kState, "the base mesh must come first; give it before the chunks");
  if (chunk >= applied_.size())
    return fail(ErrorCode::kState,
                "there is no such chunk; the manifest lists those that there are");
  auto done = refiner_->apply(chunk, bytes);
  applied_[chunk] = done.has_value();
  needs_restart_ = !done;
  return done;
}

void BrowserModel::trim() {
  if (!refiner_ || needs_restart_ || !triangles_) return;
  const std::uint32_t before = refiner_->face_count();
  refiner_->undo_to_faces(*triangles_);
  needs_restart_ = refiner_->face_count() != before;
}

double BrowserModel::bytes_held() const {
  double bytes = static_cast<double>(manifest_->head_bytes());
  for (std::size_t i = 0; i < applied_.size(); ++i) {
    if (applied_[i]) bytes += static_cast<double>(manifest_->chunks[i].length);
  }
  return bytes;
}

std::uint32_t BrowserModel::displayed_vertices() const {
  return is_textured() ? refiner_->wedges().size() : refiner_->vertex_count();
}

VertexId BrowserModel::parent_of(VertexId v) const {
  return is_textured() ? refiner_->wedges().parent(v) : refiner_->parent_of(v);
}

void BrowserModel::display() {
  shown_ = {};
  vertices_out_ = faces_out_ = 0;
  for (VertexId v = 0; v < refiner_->vertex_count(); ++v)
    shown_.push_back(to_floats(refiner_->display_position(v) - centre_));
}

std::uint32_t BrowserModel::next_vertices() {
  const VertexId last = shown_.empty() ? 0 : displayed_vertices();
  const VertexId end = std::min(last, vertices_out_ + kPiece);
  const std::uint32_t count = end - vertices_out_;
  positions_.clear();
  normals_.clear();
  attributes_.truncate(0);
  lattice_positions_.clear();
  coordinates_.clear();
  for (; vertices_out_ < end; ++vertices_out_) {
    if (is_textured()) {
      add_wedge(refiner_->wedges()[vertices_out_]);
    } else {
      add_vertex(vertices_out_);
    }
  }
  if (count == 0) shown_ = {}, vertices_out_ = 0;
  return count;
}

void BrowserModel::add_vertex(VertexId v) {
  positions_.push_back(to_floats(shown(v) * manifest_->lattice.step));
  const Vec3 n = normal(v);
  normals_.push_back({to_snorm(n.x), to_snorm(n.y), to_snorm(n.z), 0});
  lattice_positions_.push_back(refiner_->positions()[v]);
  append_displayed(attributes_, refiner_->attributes(), v);
}

void BrowserModel::add_wedge(const Wedge& wedge) {
  add_vertex(wedge.vertex);
  const auto side = static_cast<float>(manifest_->texture.side);
  coordinates_.push_back(
      {static_cast<float>(wedge.at.x) / side, static_cast<float>(wedge.at.y) / side});
}

Vec3 BrowserModel::shown(VertexId v) const {
  const auto& [x, y, z] = shown_[v];
  return {x, y, z};
}

Vec3 BrowserModel::normal(VertexId v) const {
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

std::uint32_t BrowserModel::next_faces() {
  const Connectivity& mesh = refiner_->connectivity();
  const Wedges& wedges = refiner_->wedges();
  const auto vertex = [&](Corner c) { return is_textured() ? wedges.of(c) : mesh.vertex(c); };
  faces_.clear();
  for (; faces_out_ < mesh.face_count() && faces_.size() < kPiece; ++faces_out_) {
    const Corner c = 3 * faces_out_;
    if (mesh.is_real(faces_out_)) faces_.push_back({vertex(c), vertex(c + 1), vertex(c + 2)});
  }
  return static_cast<std::uint32_t>(faces_.size());
}

const std::vector<double>& BrowserModel::summary() {
  const Manifest& m = *manifest_;
  const auto number = [](auto value) { return static_cast<double>(value); };
  const Vec3 centre = m.lattice.origin + centre_ * m.lattice.step;
  summary_.clear();
  const auto add = [&](std::initializer_list<double> numbers) {
    for (const double value : numbers)
      summary_.push_back(value);
  };
  add({number(m.levels.size()), number(m.chunks.size()), number(m.base_offset),
       number(m.base_length), number(m.file_bytes), number(semantic_bits(m.attributes)),
       number(m.lattice.bits), m.lattice.step, centre.x, centre.y, centre.z});
  for (std::uint32_t i = 0; i < m.levels.size(); ++i) {
    const LevelInfo& level = m.levels[i];
    add({number(level.vertices), number(level.faces), level.max_error, level.rms_error,
         number(m.cumulative_bytes(i))});
  }
  for (const ChunkInfo& chunk : m.chunks) {
    add({number(chunk.level), number(chunk.region), number(chunk.offset), number(chunk.length)});
  }
  if (!m.texture.empty()) summarise_texture();
  return summary_;
}

void BrowserModel::summarise_texture() {
  const TextureInfo& t = manifest_->texture;
  const auto add = [this](auto... values) {
    (summary_.push_back(static_cast<double>(values)), ...);
  };
  add(t.atlas_offset, t.atlas_length, static_cast<int>(t.alpha_mode), t.alpha_cutoff,
      t.is_double_sided, t.is_unlit, t.pictures.size(), t.in_head);
  for (const PictureInfo& picture : t.pictures)
    add(static_cast<int>(picture.role), picture.side, picture.offset, picture.length);
}

}  // namespace vitrine::inline codec
