// SPDX-License-Identifier: Apache-2.0
#include "server/cli/support/surface_file.h"

#include "codec/build/open_model.h"
#include "codec/import/read_drc.h"
#include "codec/mesh/unit.h"

namespace vitrine::server::cli {
namespace {

// Whether a reader states this reason for vertex colours without materials or pictures. A texturing
// has them nevertheless.
bool is_about_colours(std::string_view reason) {
  return reason.starts_with("the vertices ") || reason.starts_with("only one ");
}

// Returns the lines of a reader's report about materials and pictures that the texturing lacks.
// These lines state a reason.
std::vector<std::string> not_carried(const ImportedMesh& imported) {
  constexpr std::string_view kMark = " not carried: ";
  std::vector<std::string> lines;
  for (const std::string& line : imported.repairs) {
    const std::size_t at = line.find(kMark);
    if (at == line.npos) continue;
    const auto reason = std::string_view(line).substr(at + kMark.size());
    if (imported.texturing.empty() || !is_about_colours(reason)) lines.push_back(line);
  }
  return lines;
}

Expected<SurfaceInput> surface_in(const InputFile& file, const ReadOptions& reading,
                                  SurfaceParts parts) {
  if (is_drc(file.bytes()))
    return read_drc(file.bytes()).map([](TriangleMesh&& mesh) {
      return SurfaceInput{.mesh = std::move(mesh)};
    });
  if (!file.is_pmesh()) {
    auto imported = read_mesh(file.bytes(), reading);
    if (!imported) return tl::unexpected(imported.error());
    SurfaceInput surface{.mesh = std::move(imported->mesh), .unit = std::move(imported->unit)};
    if (parts == SurfaceParts::kShape) return surface;
    surface.not_carried = not_carried(*imported);
    surface.texturing = std::move(imported->texturing);
    return surface;
  }
  auto refiner = open_model(file.bytes());
  if (!refiner) return tl::unexpected(refiner.error());
  const Manifest& manifest = refiner->manifest();
  const WantLevel finest{static_cast<std::uint32_t>(manifest.levels.size() - 1)};
  const auto refined = refine(*refiner, finest, chunks_of(manifest, file.bytes()));
  if (!refined) return tl::unexpected(refined.error());
  return SurfaceInput{.mesh = refiner->display_mesh(), .unit = manifest.unit};
}

}  // namespace

Expected<SurfaceInput> read_surface(const InputFile& file, const std::string& name,
                                    const ReadOptions& reading, SurfaceParts parts) {
  return surface_in(file, reading, parts).map_error([&](const Error& error) {
    return Error{error.code, name + ": " + error.message};
  });
}

void convert(SurfaceInput& surface, std::string_view unit) {
  const auto from = metres_per(surface.unit), to = metres_per(unit);
  if (!from || !to || *from == *to) return;
  for (Vec3& p : surface.mesh.positions)
    p = p * (*from / *to);
}

}  // namespace vitrine::server::cli
