// SPDX-License-Identifier: Apache-2.0
// Which models there are, what is known about them, and where the bytes of each chunk lie. The only
// part of an installation that changes; everything it points to is immutable.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "codec/core/expected.h"
#include "codec/core/sha256.h"
#include "server/catalogue/jobs.h"
#include "server/catalogue/model_id.h"

namespace vitrine {

// The elements of Dublin Core (ISO 15836) that have no field of their own here.
inline constexpr std::string_view kDublinCore[] = {
    "contributor", "coverage", "date",   "description", "identifier", "language",
    "publisher",   "relation", "source", "subject",     "type"};

enum class ModelState : std::uint8_t { kDraft = 0, kPublished = 1 };

// What visitors get of a model whose full resolution is not public: a file of its own.
struct PublicPart {
  std::uint32_t max_level = 0;
  Sha256 file{};
  std::uint64_t file_bytes = 0, head_bytes = 0, faces = 0, vertices = 0;
};

struct ModelRecord {
  ModelId id;
  ModelState state = ModelState::kDraft;
  std::int64_t created = 0;  // milliseconds since 1970, UTC
  std::string title;
  std::string creator;
  std::string rights;                       // a statement for people
  std::string licence;                      // an SPDX identifier or a URL
  std::map<std::string, std::string> more;  // elements of Dublin Core by name, none empty
  std::string unit;                         // of the model's coordinates, empty where unknown
  Sha256 file{};                            // the .pmesh object
  std::uint64_t file_bytes = 0;
  std::uint64_t head_bytes = 0;  // header and base mesh, the file's first bytes
  std::uint64_t faces = 0, vertices = 0;
  std::optional<double> accuracy = {};         // of the scan, in `unit`
  std::optional<PublicPart> public_part = {};  // nothing: all of it is public
  std::uint64_t version = 0;                   // grows with each change
};

// An object that a model names.
struct NamedFile {
  ModelId model;
  Sha256 file{};
  std::uint64_t bytes = 0;
};

// How many models name the files; those of one follow each other.
inline std::size_t models_in(std::span<const NamedFile> files) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < files.size(); ++i)
    count += i == 0 || files[i].model != files[i - 1].model ? 1 : 0;
  return count;
}

// A chunk (or a base mesh) is a range of a stored file.
struct ChunkPlace {
  Sha256 chunk{};
  std::uint64_t offset = 0, length = 0;
};

struct ChunkLocation {
  ModelId model;
  ChunkPlace place;
};

// What a token may do; each role includes those before it.
enum class Role : std::uint8_t { kNone = 0, kViewer = 1, kOperator = 2, kAdmin = 3 };

struct TokenRecord {
  ModelId id;
  Role role = Role::kNone;
  Sha256 hash{};             // of the token's text, which is stored nowhere
  std::string label;         // for people
  std::int64_t created = 0;  // milliseconds since 1970, UTC
};

struct ModelQuery {
  std::string text;              // every word occurs in title or creator; empty: all models
  std::optional<ModelId> after;  // the cursor: `next` of the page before
  std::uint32_t limit = 50;      // 1..kMaxPage
  bool drafts = false;           // list drafts too
};
inline constexpr std::uint32_t kMaxPage = 200;

struct ModelPage {
  std::vector<ModelRecord> models;  // newest first
  std::optional<ModelId> next;      // nothing on the last page
};

// Safe to use from several threads at once, and by several processes on the same data. Errors are
// kIo where the database refuses, kLimit where the disk is full, kState as stated.
class Catalogue {
 public:
  virtual ~Catalogue() = default;

  // Adds a model and its chunks in one transaction, in which the job, where there is one, learns of
  // its model. kState where the id exists, or somebody else has taken the job.
  virtual Expected<void> add(const ModelRecord& model, std::span<const ChunkPlace> chunks,
                             const std::optional<JobClaim>& by = std::nullopt) = 0;

  // Makes a model visible or hides it, in one statement. kState where there is no such model.
  virtual Expected<void> set_state(const ModelId& id, ModelState state) = 0;

  // Writes over the model of that id but for its `created`, and over its chunks where some are
  // given, in one transaction, with the job as add() does; its version grows. kState where there is
  // none, or its version is not `model.version`: somebody else has changed it meanwhile.
  virtual Expected<void> update(const ModelRecord& model,
                                std::optional<std::span<const ChunkPlace>> chunks,
                                const std::optional<JobClaim>& by = std::nullopt) = 0;

  // Takes a model away, with its chunks. kState where there is none, or its version is another than
  // the one that is stated.
  virtual Expected<void> remove(const ModelId& id, std::optional<std::uint64_t> version) = 0;

  // Every object that a model names, once for each that does, drafts too: its file, and what is
  // public of it where that is less. By model.
  virtual Expected<std::vector<NamedFile>> files() = 0;

  virtual Expected<std::optional<ModelRecord>> find(const ModelId& id) = 0;  // drafts too

  // The newest published model of the same file whose texts are those of `model`.
  virtual Expected<std::optional<ModelRecord>> find_same(const ModelRecord& model) = 0;

  virtual Expected<ModelPage> search(const ModelQuery& query) = 0;

  // Where a chunk's bytes lie; published models only.
  virtual Expected<std::optional<ChunkLocation>> find_chunk(const Sha256& chunk) = 0;

  // Adds a token. kState where the id or the hash exists.
  virtual Expected<void> add_token(const TokenRecord& token) = 0;

  // The tokens, none of them revoked, whose hashes start with the same four bytes as `hash`: the
  // caller compares the rest, in constant time.
  virtual Expected<std::vector<TokenRecord>> tokens_like(const Sha256& hash) = 0;

  virtual Expected<std::vector<TokenRecord>> tokens() = 0;  // those in force, oldest first

  // Makes a token worthless for good. kState where there is none, or it was revoked before.
  virtual Expected<void> revoke_token(const ModelId& id) = 0;

  // A number that differs once anybody, this process or another, has changed the catalogue. Cheap:
  // what is cached from the catalogue holds as long as it stays.
  virtual Expected<std::uint64_t> revision() = 0;
};

}  // namespace vitrine
