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
  bool is_new = false;  // it was not there before

  std::vector<ChunkPlace> chunks() const;  // the base mesh is one
};

// Stores the file, reads it back, and checks the header and the SHA-256 of the base and of every
// chunk: what a visitor is served is what the header promises. kBadInput where it is damaged; then
// nothing is left of it. Call it with the store's lock held.
Expected<StoredFile> store_file(ObjectStore& store, std::span<const std::uint8_t> pmesh);

}  // namespace vitrine
