// SPDX-License-Identifier: Apache-2.0
// From .pmesh bytes to a model that visitors can open.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "server/catalogue/catalogue.h"
#include "server/store/object_store.h"
#include "server/store/quota.h"

namespace vitrine {

struct ModelMetadata {
  std::string title, creator, rights, licence;
  std::map<std::string, std::string> more = {};  // as in ModelRecord
};

// kBadInput where one is not a short line of UTF-8.
Expected<void> check_texts(const ModelMetadata& metadata);

struct PublishAs {
  ModelState state = ModelState::kPublished;
  // Where a model has this id already, it is the result: who is interrupted tries again with the
  // same id. Nothing: a new one.
  std::optional<ModelId> id = std::nullopt;
  Quota* quota = nullptr;  // that the files have to fit into; null: there is none
  std::optional<UploadId> upload = std::nullopt;  // of which they are made, and which goes then
  std::optional<JobClaim> by = std::nullopt;      // the job that publishes, while it is held
};

struct Publication {
  ModelId id;
  bool is_new = true;  // false: this model was there already
};

// Stores the file, reads it back from the store to check the header and the SHA-256 of the base and
// of every chunk, and then adds the model in one transaction: a crash at any point leaves at most
// an object that nothing names, and a failure not even that. To publish the same bytes under the
// same texts gives the model that is published already, and repairs its file where that is lost or
// damaged. Fails with kBadInput where the file is damaged, kLimit where it does not fit.
Expected<Publication> publish(ObjectStore& store, Catalogue& catalogue,
                              std::span<const std::uint8_t> pmesh, const ModelMetadata& metadata,
                              const PublishAs& as = {});

}  // namespace vitrine
