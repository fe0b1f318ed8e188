// SPDX-License-Identifier: Apache-2.0
#include "support/encoded_model.h"

#include <algorithm>
#include <set>
#include <stdexcept>

#include "codec/base/base_decoder.h"
#include "codec/base/base_encoder.h"
#include "codec/progressive/layer_encoder.h"

namespace vitrine::test {
namespace {

template <class T>
T value_of(Expected<T> result, const char* step) {
  if (!result) throw std::runtime_error(std::string(step) + ": " + result.error().message);
  return std::move(*result);
}

Hierarchy make_hierarchy(const LatticeMesh& fine, SimplifyOptions options) {
  auto hierarchy = value_of(simplify(fine, options), "simplify");
  const bool forks = hierarchy.fork_level >= 2 && hierarchy.fork_level <= hierarchy.levels.size();
  if (options.regions == 1 || forks) return hierarchy;
  options.regions = 1;
  return value_of(simplify(fine, options), "simplify");
}

Manifest frame_of(const Hierarchy& hierarchy, const LatticeMesh& fine) {
  Manifest m{.lattice = fine.lattice, .placement = hierarchy.placement};
  m.coloured = !fine.colours.empty();
  m.loops = hierarchy.loops;
  m.regions = hierarchy.regions;
  m.fork_level = hierarchy.fork_level;
  m.planes = hierarchy.planes;
  std::vector<std::set<std::uint32_t>> adjacent(m.regions);
  for (const Triangle& t : fine.faces) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint16_t a = hierarchy.region[t[k]], b = hierarchy.region[t[(k + 1) % 3]];
      if (a != b) adjacent[a].insert(b), adjacent[b].insert(a);
    }
  }
  for (const auto& set : adjacent)
    m.adjacency.emplace_back(set.begin(), set.end());
  return m;
}

void add_level(const LayerEncoder& encoder, Manifest& manifest) {
  manifest.levels.push_back(
      {.vertices = encoder.mesh().vertex_count(),
       .faces = static_cast<std::uint32_t>(encoder.mesh().real_faces().size())});
}

}  // namespace

EncodedModel encode_model(const LatticeMesh& fine, SimplifyOptions options) {
  const Hierarchy hierarchy = make_hierarchy(fine, options);
  Manifest manifest = frame_of(hierarchy, fine);
  const EncodedBase base = value_of(encode_base({.positions = hierarchy.base.positions,
                                                 .faces = hierarchy.base.faces,
                                                 .colours = hierarchy.base_colours}),
                                    "base");
  manifest.base_length = base.bytes.size();
  manifest.base_sha256 = sha256(base.bytes);
  std::vector<VertexId> fine_ids;
  for (const std::uint32_t v : base.original)
    fine_ids.push_back(hierarchy.base_ids[v]);
  auto encoder =
      value_of(LayerEncoder::start(hierarchy, base.decoded, std::move(fine_ids)), "encoder");
  add_level(encoder, manifest);
  std::vector<std::uint8_t> chunks;
  for (std::uint32_t level = 1; level <= hierarchy.levels.size(); ++level) {
    for (const EncodedChunk& chunk : value_of(encoder.encode_level(), "level")) {
      manifest.chunks.push_back({.level = level,
                                 .region = chunk.region,
                                 .length = chunk.bytes.size(),
                                 .splits = chunk.splits,
                                 .sha256 = sha256(chunk.bytes)});
      chunks.insert(chunks.end(), chunk.bytes.begin(), chunk.bytes.end());
    }
    add_level(encoder, manifest);
  }
  EncodedModel model{.manifest = {}, .base = {}, .file = write_header(manifest)};
  model.manifest = value_of(parse_header(model.file), "header");
  model.file.insert(model.file.end(), base.bytes.begin(), base.bytes.end());
  model.file.insert(model.file.end(), chunks.begin(), chunks.end());
  model.base = value_of(
      decode_base(
          std::span(model.file).subspan(model.manifest.base_offset, model.manifest.base_length),
          model.manifest),
      "base");
  return model;
}

Refiner start_refiner(const EncodedModel& model) {
  return value_of(Refiner::start(model.manifest, model.base), "refiner");
}

void apply_chunk(Refiner& refiner, const EncodedModel& model, std::size_t chunk) {
  const auto done = refiner.apply(chunk, model.chunk(chunk));
  if (!done)
    throw std::runtime_error("chunk " + std::to_string(chunk) + ": " + done.error().message);
}

std::vector<std::size_t> ready_chunks(const Refiner& refiner) {
  std::vector<std::size_t> ready;
  for (std::size_t i = 0; i < refiner.manifest().chunks.size(); ++i) {
    if (refiner.ready(i)) ready.push_back(i);
  }
  return ready;
}

std::vector<SurfaceFace> canonical_surface(const LatticeMesh& mesh) {
  std::vector<SurfaceFace> faces;
  faces.reserve(mesh.faces.size());
  for (const Triangle& t : mesh.faces) {
    SurfaceFace face{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3i& p = mesh.positions[t[k]];
      const Colour c = mesh.colours.empty() ? Colour{} : mesh.colours[t[k]];
      const std::array<std::int32_t, 6> corner = {p.x, p.y, p.z, c[0], c[1], c[2]};
      std::copy(corner.begin(), corner.end(), face.begin() + static_cast<std::ptrdiff_t>(6 * k));
    }
    SurfaceFace once = face, twice = face;
    std::rotate(once.begin(), once.begin() + 6, once.end());
    std::rotate(twice.begin(), twice.begin() + 12, twice.end());
    faces.push_back(std::min({face, once, twice}));
  }
  std::sort(faces.begin(), faces.end());
  return faces;
}

}  // namespace vitrine::test
