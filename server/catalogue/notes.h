// SPDX-License-Identifier: Apache-2.0
// The notes on models and the tours through them: one JSON document of each kind for each model.
#pragma once

#include <cstdint>
#include <string>

#include "codec/core/expected.h"
#include "server/catalogue/id.h"

namespace vitrine::server {

enum class NoteKind : std::uint8_t { kNotes = 0, kTours = 1 };

struct NoteSheet {
  std::uint64_t version = 0;  // increases with each change; 0: nothing was stored yet
  std::uint32_t entries = 0;  // number of notes or tours
  std::string text = {};      // a JSON list; empty if nothing was stored yet
};

// Safe to use from several threads at once, and by several processes on the same data. When a model
// is removed from the catalogue, its rows are removed, too. All functions fail with kIo if the
// database fails and with kLimit if the disk is full.
class NoteCatalogue {
 public:
  virtual ~NoteCatalogue() = default;

  // Returns the document of this kind. Does not check whether the model exists.
  virtual Expected<NoteSheet> find(const ModelId& model, NoteKind kind) = 0;

  // Replaces the document, and increments its version. Changes Catalogue::revision(). Fails with
  // kState if the model does not exist, or if the stored version is not `sheet.version` because
  // another caller has changed the document.
  virtual Expected<void> put(const ModelId& model, NoteKind kind, const NoteSheet& sheet) = 0;
};

}  // namespace vitrine::server
