// SPDX-License-Identifier: Apache-2.0
#include "server/cli/support/surface_file.h"

#include <algorithm>
#include <iterator>

#include "codec/build/exported_texture.h"
#include "codec/build/open_model.h"
#include "codec/import/read_drc.h"
#include "codec/mesh/unit.h"

namespace vitrine::server::cli {
namespace {

// Returns the lines of a reader's report about materials or pictures that the texturing lacks. Such
// lines contain " not carried: " and a reason.
std::vector<std::string> not_carried(const ImportedMesh& imported) {
  std::vector<std::string> lines;
  std::ranges::copy_if(imported.repairs, std::back_inserter(lines), [](const std::string& line) {
    return line.find(" not carried: ") != line.npos;
  });
  return lines;
}

// Returns a texturing with the finest pictures of a model, or an empty one if the model has no
// pictures.
Expected<Texturing> finest_texturing(const Refiner& refiner, std::span<const std::uint8_t> pmesh) {
  const Manifest& manifest = refiner.manifest();
  const auto pictures = pictures_to_export(manifest, refiner.face_count(), std::nullopt);
  return texturing_to_export(refiner, pictures,
                             [&](std::size_t i) { return picture_of(manifest, pmesh, i); });
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
  SurfaceInput surface{.mesh = refiner->display_mesh(), .unit = manifest.unit};
  if (parts == SurfaceParts::kShape) return surface;
  auto texturing = finest_texturing(*refiner, file.bytes());
  if (!texturing) return tl::unexpected(texturing.error());
  surface.texturing = std::move(*texturing);
  return surface;
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
