// SPDX-License-Identifier: Apache-2.0
// Publishes the bytes of a .pmesh file as a model that visitors can open.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "server/catalogue/catalogue.h"
#include "server/store/object_store.h"
#include "server/store/quota.h"

namespace vitrine::server {

struct ModelMetadata {
  std::string title, creator, rights, licence;
  std::map<std::string, std::string> more = {};  // see ModelRecord::more
};

// Checks the texts. Rights, description and provenance may have several paragraphs; every other
// text must be one short line (server/metadata/text.h). Each text must be a value that
// expected_text() allows. Fails with kBadInput.
Expected<void> check_texts(const ModelMetadata& metadata);

struct PublishAs {
  ModelState state = ModelState::kPublished;
  // ID of the new model; nullopt: publish() generates one. If a model with this ID exists,
  // publish() returns that model, so that an interrupted caller can retry with the same ID.
  std::optional<ModelId> id = std::nullopt;
  Quota* quota = nullptr;  // limits all models and uploads together; null: no limit
  // The upload from which the files were made. It does not count towards the quota, because it is
  // removed afterwards.
  std::optional<UploadId> upload = std::nullopt;
  std::optional<JobClaim> by = std::nullopt;  // claim of the job that publishes
  std::string repairs = {};                   // see ModelRecord::repairs; plain text
};

struct Publication {
  ModelId id;
  bool is_new = true;  // false if the model existed already
};

// Publishes a .pmesh file. Stores the file, reads it back, and checks the header and the SHA-256 of
// the base and of every chunk. Then adds the model to the catalogue in one transaction. A failure
// leaves nothing in the store. Only after a crash, or if the catalogue or the store fails (kIo), an
// unreferenced object may be left. If the same bytes are already published with the same texts,
// returns that model, repairs its file if it is lost or damaged, and stores `as.repairs` if they
// are not empty. Fails with kBadInput if the file is damaged, and with kLimit if the disk is full
// or the quota is exhausted.
Expected<Publication> publish(ObjectStore& store, Catalogue& catalogue,
                              std::span<const std::uint8_t> pmesh, const ModelMetadata& metadata,
                              const PublishAs& as = {});

}  // namespace vitrine::server
