// SPDX-License-Identifier: Apache-2.0
// A .pmesh as an object of the store.
#pragma once

#include "codec/progressive/manifest.h"
#include "server/catalogue/catalogue.h"
#include "server/store/object_store.h"

namespace vitrine {

struct StoredFile {
  Sha256 name{};
  Manifest manifest;
  bool is_new = false;       // it was not there before
  bool is_repaired = false;  // it was there, and damaged

  std::vector<ChunkPlace> chunks() const;  // the base mesh is one
};

// What the file will be in the store. kBadInput where its header or its length is not right.
Expected<StoredFile> to_be_stored(std::span<const std::uint8_t> pmesh);

// Stores `file`, which is that of `pmesh`, reads it back, and checks the SHA-256 of the base and of
// every chunk: what a visitor is served is what the header promises. kBadInput where it is damaged;
// then nothing is left of it. Call it with the store's lock held.
Expected<void> store_file(ObjectStore& store, StoredFile& file,
                          std::span<const std::uint8_t> pmesh);

// Makes it the record's file.
void describe(ModelRecord& record, const StoredFile& file);

}  // namespace vitrine
