// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "masked_pictures.h"
#include "sections.h"
#include "support/product_names.h"
#include "textured_draco.h"

namespace vitrine::bench {
namespace {

// Maximum ratio of our texture coordinates' bytes to Draco's. The limit applies to the geometric
// mean over all models.
constexpr double kMaxCoordinates = 0.75;
// Largest accepted ratio of the positions' bytes to those in the same model without texture.
constexpr double kMaxPositions = 1.03;
// Largest accepted ratio of the file's bytes to those of a Draco file with unmasked pictures.
constexpr double kMaxWhole = 0.9;

double bytes_of_pictures(const TexturedModel& model) {
  double sum = 0;
  for (const std::uint32_t number : used_pictures(model.texturing, kMapsOfMaterial))
    sum += static_cast<double>(unmasked_picture(model, number).size());
  return sum;
}

// Returns the bytes of the file without its texture.
double bytes_of_geometry(Manifest manifest) {
  const std::uint64_t body = manifest.base_length + manifest.chunk_bytes();
  manifest.texture = {};
  return static_cast<double>(write_header(manifest).size() + body);
}

// Returns the ratio of the bytes of our texture coordinates to those of Draco.
double compare(Report& report, const TexturedModel& model) {
  const Manifest textured = model.build(kBits).report.manifest;
  const Manifest bare = model.build_untextured(textured.has(Semantic::kColour)).report.manifest;
  const double positions = bytes_of_geometry(textured);
  const auto bare_bytes = static_cast<double>(bare.file_bytes);
  report.add({"positions." + model.name, "ratio_to_untextured", positions, bare_bytes,
              positions / bare_bytes, kMaxPositions});

  const MeshoptInput wedges = wedge_mesh(model.mesh, model.texturing);
  const std::size_t materials = model.texturing.materials.size();
  const double draco = total_bytes(draco_with_coordinates(wedges, materials, kBits));
  const auto atlas = static_cast<double>(textured.texture.atlas_length);
  const double coordinates =
      draco - total_bytes(draco_without_coordinates(wedges, materials, kBits));
  report.add({"coordinates." + model.name, "ratio_to_draco", atlas, coordinates,
              atlas / coordinates, kNoThreshold});

  const double whole = draco + bytes_of_pictures(model);
  const auto file = static_cast<double>(textured.file_bytes);
  report.add({"whole." + model.name, "ratio_to_draco_and_unmasked_webp", file, whole, file / whole,
              kMaxWhole});
  return atlas / coordinates;
}

}  // namespace

void sizes(Report& report, const std::vector<TexturedModel>& models) {
  double log_sum = 0;
  for (const TexturedModel& model : models)
    log_sum += std::log(compare(report, model));
  report.add({"coordinates.geometric_mean", "ratio_to_draco", 0, 0,
              std::exp(log_sum / static_cast<double>(models.size())), kMaxCoordinates});
}

}  // namespace vitrine::bench
