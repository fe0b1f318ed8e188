// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "../codec/peers.h"
#include "accuracy.h"
#include "acquisition/rig_optics/object_file.h"
#include "acquisition/session/processing.h"
#include "codec/base/base_encoder.h"
#include "codec/build/build_model.h"
#include "codec/build/open_model.h"
#include "codec/build/refine.h"
#include "codec/distance/surface_distance.h"
#include "codec/export/write_mesh.h"
#include "picture.h"
#include "sections.h"
#include "simulated_scanner.h"
#include "support/product_names.h"
#include "value_of.h"

namespace vitrine::bench {
namespace {

// Numbers of polygons of the levels a, b, c and d of [WLL] table 2, finest first.
using Polygons = std::array<std::uint64_t, 4>;
constexpr Polygons kPortrait = {57'168, 31'951, 22'729, 15'964};
constexpr Polygons kSkull = {100'182, 55'796, 39'934, 28'526};

// Sizes from [WLL] table 2, divided by the size of the finest level's VRML file. They are the sizes
// of the layer that refines b to a, of the base with all layers, and of separate files for all
// levels.
constexpr double kPaperLayer = 0.81, kPaperLayered = 1.26, kPaperFiles = 1.96;

struct State {
  TriangleMesh mesh;
  LatticeMesh lattice;
  double bytes = 0;  // length of the stream up to this state
};

// Returns the number of bytes that a model of `polygons` polygons needs. Interpolates between two
// levels, because chunks are larger than the differences in the table.
double bytes_of(const Manifest& manifest, double polygons) {
  std::size_t above = 1;
  while (above + 1 < manifest.levels.size() && manifest.levels[above].faces < polygons)
    ++above;
  const auto bytes = [&](std::size_t level) {
    return static_cast<double>(manifest.cumulative_bytes(static_cast<std::uint32_t>(level)));
  };
  const double low = manifest.levels[above - 1].faces, high = manifest.levels[above].faces;
  const double share = std::clamp((polygons - low) / (high - low), 0., 1.);
  return bytes(above - 1) + share * (bytes(above) - bytes(above - 1));
}

State state_of(std::span<const std::uint8_t> pmesh, std::uint64_t polygons) {
  Refiner refiner = value_of(open_model(pmesh));
  const Manifest& manifest = refiner.manifest();
  const auto refined = refine(refiner, WantTriangles{polygons}, chunks_of(manifest, pmesh));
  if (!refined) throw std::runtime_error(refined.error().message);
  return {refiner.display_mesh(), refiner.lattice_mesh(), bytes_of(manifest, refiner.face_count())};
}

double vrml_bytes(const TriangleMesh& mesh) {
  return static_cast<double>(value_of(write_mesh(mesh, MeshFormat::kVrml, {.unit = "mm"})).size());
}

// Returns the size in bytes of a file with only this mesh, encoded like a base mesh.
double alone(const LatticeMesh& mesh) {
  return static_cast<double>(value_of(encode_base({mesh.positions, mesh.faces, {}})).bytes.size());
}

TriangleMesh scanned(const Object& object, int steps) {
  SimulatedScanner scanner(value_of(rig::load({.file = object.file})), {});
  const Calibration calibration = calibration_of(scanner.picture_target());
  const auto profiles = profiles_of(scanner.scan(steps), calibration);
  return value_of(mesh_of(profiles, calibration, {})).mesh;
}

// Builds a model of the finest level of [WLL] table 2. Compares the bytes of its base and layers
// with the bytes of a file that holds only the finest level.
void layers_over_finest(Report& report, const std::string& what, const Polygons& polygons,
                        const State& finest) {
  const auto file = value_of(write_mesh(finest.mesh, MeshFormat::kPly, {.unit = "mm"}));
  const Bytes pmesh = value_of(build_model(file, {}, {})).file;
  const State a = state_of(pmesh, polygons[0]), b = state_of(pmesh, polygons[1]);
  const double single = alone(a.lattice);
  const double drc = static_cast<double>(
      draco_encode(finest.mesh, value_of(open_model(pmesh)).manifest().lattice.bits).size());
  report.add(
      {what, "layered_ratio_to_finest_alone", a.bytes, single, a.bytes / single, kPaperLayered});
  report.add({what, "layer_b_to_a_ratio_to_finest_alone", a.bytes - b.bytes, single,
              (a.bytes - b.bytes) / single, kPaperLayer});
  report.add({what, "layered_ratio_to_draco", a.bytes, drc, a.bytes / drc, kNoThreshold});
}

void table_two(Report& report, const Options& options, const Object& object,
               const Polygons& polygons) {
  const TriangleMesh scan = scanned(object, options.is_quick ? 360 : 720);
  const auto file = value_of(write_mesh(scan, MeshFormat::kPly, {.unit = "mm"}));
  const Bytes pmesh = value_of(build_model(file, {}, {})).file;
  const std::string name = "table_2." + object.name;
  std::optional<State> finest;
  double all_files = 0;
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    State state = state_of(pmesh, polygons[i]);
    const std::string what = fmt::format("{}.{}", name, "abcd"[i]);
    const double vrml = vrml_bytes(state.mesh);
    report.add({what, "polygons_ratio_to_the_papers", static_cast<double>(state.mesh.faces.size()),
                static_cast<double>(polygons[i]),
                static_cast<double>(state.mesh.faces.size()) / static_cast<double>(polygons[i]),
                kNoThreshold});
    report.add({what, "stream_ratio_to_vrml", state.bytes, vrml, state.bytes / vrml, kNoThreshold});
    judge(report, what, "rms_mm", distances(state.mesh, scan).rms);
    show(options, fmt::format("figure-10-{}-{}", object.name, "abcd"[i]), state.mesh);
    all_files += vrml;
    if (i == 0) finest = std::move(state);
  }
  const double vrml = vrml_bytes(finest->mesh);
  report.add({name, "vrml_files_ratio_to_finest", all_files, vrml, all_files / vrml, kNoThreshold});
  layers_over_finest(report, name, polygons, *finest);
}

}  // namespace

void simplification(Report& report, const Options& options, const Object& skull,
                    const Object& head) {
  table_two(report, options, head, kPortrait);
  if (!options.is_quick) table_two(report, options, skull, kSkull);
}

}  // namespace vitrine::bench
