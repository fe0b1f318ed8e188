// SPDX-License-Identifier: Apache-2.0
// Checks that the store has every file that the catalogue names, and that each file is intact.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "server/catalogue/catalogue.h"
#include "server/store/object_store.h"

namespace vitrine::server {

// Returns every file that a model refers to, ordered by SHA-256. Lists each file once, with one of
// its models. Fails with kIo.
Expected<std::vector<NamedFile>> distinct_files(Catalogue& catalogue);

// Called after each file with its state.
using OnObject = std::function<void(const NamedFile& file, ObjectState state)>;

// Checks the files one after the other by ObjectStore::check(). Fails with kIo if the store fails
// or `on_piece` returned false.
Expected<void> scrub(const ObjectStore& store, std::span<const NamedFile> files,
                     const OnPiece& on_piece, const OnObject& on_object);

struct DamagedFile {
  NamedFile file;
  ObjectState state = ObjectState::kDamaged;
};

struct ScrubReport {
  std::uint64_t objects = 0, bytes = 0;  // numbers of checked objects and of bytes read
  std::vector<DamagedFile> damaged;      // damaged and missing files
};

// Checks all files without pauses. Fails with kIo.
Expected<ScrubReport> scrub(const ObjectStore& store, Catalogue& catalogue);

// Returns a line that names the object, its state and its model.
std::string to_text(const DamagedFile& damaged);

}  // namespace vitrine::server
