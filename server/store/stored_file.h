// SPDX-License-Identifier: Apache-2.0
// Stores a .pmesh file as an object.
#pragma once

#include "codec/format/manifest.h"
#include "server/catalogue/catalogue.h"
#include "server/store/object_store.h"

namespace vitrine::server {

struct StoredFile {
  Sha256 name{};
  Manifest manifest;
  bool is_new = false;       // whether the store did not have the file before
  bool is_repaired = false;  // whether the stored object was damaged before

  std::vector<ChunkPlace> blocks() const;  // positions of all blocks of the file
};

// Returns the description of a file that will be stored. Fails with kBadInput if its header or its
// length is wrong.
Expected<StoredFile> to_be_stored(std::span<const std::uint8_t> pmesh);

// Stores the bytes `pmesh`, which `file` describes, and sets `is_new` and `is_repaired`. First
// checks the SHA-256 of every block, so that visitors receive what the header describes; fails with
// kBadInput if one is wrong. Then reads the object back. If it differs from `pmesh`, removes the
// object, unless it existed before, and fails with kIo. The caller holds the store's lock.
Expected<void> store_file(ObjectStore& store, StoredFile& file,
                          std::span<const std::uint8_t> pmesh);

TextureSummary summary_of(const TextureInfo& texture);

// Copies the description of the file to the model's record.
void describe(ModelRecord& record, const StoredFile& file);

}  // namespace vitrine::server
