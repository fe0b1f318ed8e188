// SPDX-License-Identifier: Apache-2.0
// Changes a stored model: its content, its texts and its public part.
#pragma once

#include "server/store/publish.h"

namespace vitrine::server {

// Returns the record that visitors without a token may see. If the model has a public part, the
// file, its sizes and its counts are those of the public part.
ModelRecord public_view(ModelRecord record);

// Replaces the file of the model `as.id` by `pmesh`, and its repairs by `as.repairs`. Also replaces
// the texts that `metadata` contains. The model's other texts, its public level and its
// presentation stay. Publishes a draft if `as.state` is kPublished. Fails with kState if the model
// does not exist.
Expected<Publication> replace(ObjectStore& store, Catalogue& catalogue,
                              std::span<const std::uint8_t> pmesh, const ModelMetadata& metadata,
                              const PublishAs& as);

// Changes a model and returns its new record. Takes the texts, the unit, the accuracy, the
// presentation and the max_level of public_part from `wanted`, and ignores its other members.
// Rewrites the model's files if the unit or the public part changes. Fails with kState if another
// caller has changed the model meanwhile, and with kLimit if the files exceed `quota`.
Expected<ModelRecord> change(ObjectStore& store, Catalogue& catalogue, const ModelRecord& wanted,
                             Quota* quota = nullptr);

// Removes a model. Fails with kState if the model does not exist, or if `version` is given and is
// not the model's version.
Expected<void> remove(ObjectStore& store, Catalogue& catalogue, const ModelId& id,
                      std::optional<std::uint64_t> version);

}  // namespace vitrine::server
