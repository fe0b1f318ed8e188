// SPDX-License-Identifier: Apache-2.0
#include "server/api/decoded_model.h"

#include "codec/build/open_model.h"

namespace vitrine::server {

Expected<DecodedModel> decoded_model(const PublishedModel& model, const Want& want,
                                     std::optional<std::uint32_t> texture_side,
                                     PictureRoles roles) {
  const auto head = model.read(model.head());
  if (!head) return tl::unexpected(head.error());
  auto refiner = open_model(*head);
  if (!refiner) return tl::unexpected(refiner.error());
  std::vector<std::uint8_t> bytes;  // bytes of the chunk or picture that was read last
  const auto read = [&](ByteRange range) -> Expected<std::span<const std::uint8_t>> {
    auto fresh = model.read(range);
    if (!fresh) return tl::unexpected(fresh.error());
    bytes = std::move(*fresh);
    return bytes;
  };
  const auto refined =
      refine(*refiner, want, [&](std::size_t chunk) { return read(model.chunk(chunk)); });
  if (!refined) return tl::unexpected(refined.error());
  const auto pictures =
      pictures_to_export(model.manifest(), refiner->face_count(), texture_side, roles);
  auto texturing = texturing_to_export(*refiner, pictures, [&](std::size_t i) {
    const PictureInfo& picture = model.manifest().texture.pictures[i];
    return read({picture.offset, picture.length});
  });
  if (!texturing) return tl::unexpected(texturing.error());
  DecodedModel decoded{refiner->display_mesh(), std::move(*texturing), shown_detail(*refiner)};
  if (!decoded.texturing.empty()) decoded.mesh.attributes.colours.clear();
  return decoded;
}

}  // namespace vitrine::server
