// SPDX-License-Identifier: Apache-2.0
#include "server/api/decoded_model.h"

#include "codec/build/open_model.h"
#include "server/export/placed_mesh.h"

namespace vitrine::server {
namespace {

Expected<Refiner> opened(const PublishedModel& model) {
  const auto head = model.read(model.head());
  if (!head) return tl::unexpected(head.error());
  return open_model(*head);
}

// Reads ranges of a model's file. The bytes that read() returns stay valid until the next read().
class RangeReader {
 public:
  explicit RangeReader(const PublishedModel& model) : model_(model) {}

  Expected<std::span<const std::uint8_t>> read(ByteRange range) {
    auto fresh = model_.read(range);
    if (!fresh) return tl::unexpected(fresh.error());
    bytes_ = std::move(*fresh);
    return bytes_;
  }

 private:
  const PublishedModel& model_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace

Expected<DecodedModel> decoded_model(const PublishedModel& model, const Want& want,
                                     std::optional<std::uint32_t> texture_side,
                                     PictureRoles roles) {
  auto refiner = opened(model);
  if (!refiner) return tl::unexpected(refiner.error());
  RangeReader file(model);
  const auto refined =
      refine(*refiner, want, [&](std::size_t chunk) { return file.read(model.chunk(chunk)); });
  if (!refined) return tl::unexpected(refined.error());
  const auto pictures =
      pictures_to_export(model.manifest(), refiner->face_count(), texture_side, roles);
  auto texturing = texturing_to_export(*refiner, pictures, [&](std::size_t i) {
    const PictureInfo& picture = model.manifest().texture.pictures[i];
    return file.read({picture.offset, picture.length});
  });
  if (!texturing) return tl::unexpected(texturing.error());
  DecodedModel decoded{refiner->display_mesh(), std::move(*texturing), shown_detail(*refiner)};
  if (!decoded.texturing.empty()) decoded.mesh.attributes.colours.clear();
  const PresentationTransform placement(model.record().presentation);
  place(decoded.mesh, placement);
  ShownDetail& detail = decoded.detail;
  const ExportGrid grid = placed({detail.grid_origin, detail.grid_step}, placement);
  detail = {detail.level, detail.error * placement.scale(), grid.origin, grid.step};
  return decoded;
}

Expected<std::vector<CoarserLevel>> levels_below(const DecodedModel& finest,
                                                 const PublishedModel& model) {
  auto refiner = opened(model);
  if (!refiner) return tl::unexpected(refiner.error());
  RangeReader file(model);
  const auto levels =
      coarser_levels(model.manifest(), finest.detail.level, finest.mesh.faces.size());
  auto decoded = decode_levels(std::move(*refiner), levels, !finest.texturing.empty(),
                               [&](std::size_t chunk) { return file.read(model.chunk(chunk)); });
  if (!decoded) return decoded;
  const PresentationTransform placement(model.record().presentation);
  for (CoarserLevel& level : *decoded)
    place(level, placement);
  return decoded;
}

}  // namespace vitrine::server
