// SPDX-License-Identifier: Apache-2.0
#include "server/http/decoded_model.h"

#include "codec/base/base_decoder.h"
#include "codec/progressive/refine.h"

namespace vitrine {

Expected<TriangleMesh> decoded_model(const PublishedModel& model, const Want& want) {
  const auto base_bytes = model.read(model.base());
  if (!base_bytes) return Unexpected(base_bytes.error());
  const auto base = decode_base(*base_bytes, model.manifest());
  if (!base) return Unexpected(base.error());
  auto refiner = Refiner::start(model.manifest(), *base);
  if (!refiner) return Unexpected(refiner.error());
  std::vector<std::uint8_t> bytes;  // of the newest chunk
  const auto read = [&](std::size_t chunk) -> Expected<std::span<const std::uint8_t>> {
    auto fresh = model.read(model.chunk(chunk));
    if (!fresh) return Unexpected(fresh.error());
    bytes = std::move(*fresh);
    return bytes;
  };
  if (const auto refined = refine(*refiner, want, read); !refined)
    return Unexpected(refined.error());
  return refiner->display_mesh();
}

}  // namespace vitrine
