// SPDX-License-Identifier: Apache-2.0
// What may be changed of a model that is there.
#pragma once

#include "server/store/publish.h"

namespace vitrine {

// The record as visitors without a token may see it.
ModelRecord public_view(ModelRecord record);

// Puts other bytes in the model's place: its id stays, its texts where `metadata` has none, what
// visitors may see of it, and that it is published. kState where there is no such model.
Expected<Publication> replace(ObjectStore& store, Catalogue& catalogue,
                              std::span<const std::uint8_t> pmesh, const ModelMetadata& metadata,
                              const PublishAs& as);

// Writes `wanted` over the record that it was made of: texts, unit, accuracy and public_part's
// max_level; all else in it does not matter. Where the unit or what is public changes, so do the
// files. kState where somebody else has changed the model meanwhile, kLimit where they do not fit.
Expected<ModelRecord> change(ObjectStore& store, Catalogue& catalogue, const ModelRecord& wanted,
                             Quota* quota = nullptr);

// Takes a model away. kState where there is none, or its version is another than the one that is
// stated.
Expected<void> remove(ObjectStore& store, Catalogue& catalogue, const ModelId& id,
                      std::optional<std::uint64_t> version);

}  // namespace vitrine
