// SPDX-License-Identifier: Apache-2.0
#include "support/stored_model.h"

#include <algorithm>
#include <stdexcept>

#include "codec/base/base_decoder.h"
#include "codec/build/model_encoder.h"
#include "codec/coding/atlas_coder.h"
#include "support/product_names.h"

namespace vitrine::test {
namespace {

template <class T>
T value_of(Expected<T> result, const char* step) {
  if (!result) throw std::runtime_error(std::string(step) + ": " + result.error().message);
  return std::move(*result);
}

}  // namespace

StoredModel store_model(const LatticeMesh& fine, const SimplifyOptions& options) {
  Hierarchy hierarchy = value_of(simplify(fine, options), "simplify");
  EncodedModel encoded =
      value_of(encode_model(std::move(hierarchy), [](const MeshState&) {}), "encoder");
  StoredModel model{.manifest = {}, .base = {}, .file = write_header(encoded.manifest)};
  model.manifest = value_of(parse_header(model.file), "header");
  model.file.insert(model.file.end(), encoded.body.begin(), encoded.body.end());
  model.base = value_of(
      decode_base(
          std::span(model.file).subspan(model.manifest.base_offset, model.manifest.base_length),
          model.manifest),
      "base");
  return model;
}

StoredModel with_atlas(StoredModel model, const BaseAtlas& atlas) {
  model.base.atlas = atlas;
  const auto coded = encode_atlas(model.base);
  Manifest& manifest = model.manifest;
  const std::uint64_t base = manifest.base_offset, chunks = base + manifest.base_length;
  const std::span<const std::uint8_t> before(model.file);
  manifest.texture = {
      .side = kMaxAtlasSide, .atlas_length = coded.size(), .atlas_sha256 = sha256(coded)};
  std::vector<std::uint8_t> file = write_header(manifest);
  for (const auto part : {before.subspan(base, manifest.base_length),
                          std::span<const std::uint8_t>(coded), before.subspan(chunks)})
    file.insert(file.end(), part.begin(), part.end());
  model.file = std::move(file);
  return model;
}

Refiner start_refiner(const StoredModel& model) {
  return value_of(Refiner::start(model.manifest, model.base), "refiner");
}

void apply_chunk(Refiner& refiner, const StoredModel& model, std::size_t chunk) {
  const auto done = refiner.apply(chunk, model.chunk(chunk));
  if (!done)
    throw std::runtime_error("chunk " + std::to_string(chunk) + ": " + done.error().message);
}

std::vector<std::size_t> ready_chunks(const Refiner& refiner) {
  std::vector<std::size_t> ready;
  for (std::size_t i = 0; i < refiner.manifest().chunks.size(); ++i) {
    if (refiner.is_ready(i)) ready.push_back(i);
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
      const Colour c = mesh.attributes.row(t[k]).colour;
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
