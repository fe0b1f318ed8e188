// SPDX-License-Identifier: Apache-2.0
// The catalogue of models. It stores each model's metadata and the location of each chunk's bytes.
// A model changes only in the catalogue, because the objects that it refers to are immutable.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "codec/core/expected.h"
#include "codec/core/sha256.h"
#include "server/catalogue/id.h"
#include "server/catalogue/jobs.h"
#include "server/metadata/presentation.h"

namespace vitrine::server {

enum class ModelState : std::uint8_t { kDraft = 0, kPublished = 1 };

// The pictures of a texture in a .pmesh file. All numbers are 0 if the model has no texture.
struct TextureSummary {
  std::uint32_t count = 0;         // number of kinds of pictures: base colours, normals, ...
  std::uint32_t largest_side = 0;  // side of the largest picture, a square, in pixels
  std::uint64_t bytes = 0;         // total size of all pictures, in all sizes
  bool operator==(const TextureSummary&) const = default;
};

// The file that visitors receive if the full resolution of a model is not public.
struct PublicPart {
  std::uint32_t max_level = 0;
  Sha256 file{};
  std::uint64_t file_bytes = 0, head_bytes = 0, faces = 0, vertices = 0;
  TextureSummary textures = {};
};

struct ModelRecord {
  ModelId id;
  ModelState state = ModelState::kDraft;
  std::int64_t created = 0;  // milliseconds since 1970, UTC
  std::string title;
  std::string creator;
  std::string rights;                       // rights statement in words
  std::string licence;                      // SPDX identifier or URL of the licence
  std::map<std::string, std::string> more;  // other metadata texts by name; no value is empty
  std::string unit;                         // unit of the coordinates; empty if unknown
  Sha256 file{};                            // SHA-256 of the .pmesh file
  std::uint64_t file_bytes = 0;
  std::uint64_t head_bytes = 0;  // size of the model's head; see Manifest::head_bytes()
  std::uint64_t faces = 0, vertices = 0;
  TextureSummary textures = {};
  std::optional<double> accuracy = {};         // accuracy of the scan, in `unit`
  std::optional<PublicPart> public_part = {};  // nullopt: the whole model is public
  std::uint64_t version = 0;                   // increases with each change
  // Repairs and losses of the build of the file, one line for each kind. Empty if there were none,
  // or if they are unknown.
  std::string repairs = {};
  Presentation presentation = {};
  // Number of notes, which NoteCatalogue::put() changes. Catalogue::add() and update() ignore it.
  std::uint64_t notes = 0;
};

// A file in the object store that a model refers to.
struct NamedFile {
  ModelId model;
  Sha256 file{};
  std::uint64_t bytes = 0;
};

// Returns the number of models that refer to `files`. Files of one model must be adjacent.
inline std::size_t models_in(std::span<const NamedFile> files) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < files.size(); ++i)
    count += i == 0 || files[i].model != files[i - 1].model ? 1 : 0;
  return count;
}

// The place of a block (chunk, base mesh, atlas or picture) in a stored file.
struct ChunkPlace {
  Sha256 chunk{};
  std::uint64_t offset = 0, length = 0;
};

struct ChunkLocation {
  ModelId model;
  ChunkPlace place;
};

// The role of a token. Each role includes the permissions of the roles before it.
enum class Role : std::uint8_t { kNone = 0, kViewer = 1, kOperator = 2, kAdmin = 3 };

struct TokenRecord {
  TokenId id;
  Role role = Role::kNone;
  Sha256 hash{};             // SHA-256 of the token's text, which is not stored
  std::string label;         // description given by the token's creator
  std::int64_t created = 0;  // milliseconds since 1970, UTC
};

// The metadata texts by which visitors can filter a search. A text with semicolons has several
// values.
inline constexpr std::string_view kFacetNames[] = {"subject",  "creator", "period",
                                                   "material", "licence", "collection"};
inline constexpr std::uint32_t kMostFacetValues = 30;  // largest number of values per facet

enum class ModelOrdering : std::uint8_t { kNewest = 0, kOldest = 1, kTitle = 2, kCreator = 3 };

struct ModelQuery {
  // Search words. Each must be the beginning of a word in the model's texts, regardless of case and
  // accents. Empty: all models.
  std::string text;
  std::map<std::string, std::string> facets = {};  // required values by facet name
  ModelOrdering ordering = ModelOrdering::kNewest;
  std::optional<ModelId> after;  // the cursor: `next` of the previous page
  std::uint32_t limit = 50;      // 1..kMaxPage
  bool includes_drafts = false;  // whether the result includes drafts
};
inline constexpr std::uint32_t kMaxPage = 200;

struct ModelPage {
  std::vector<ModelRecord> models;
  std::optional<ModelId> next;  // nullopt on the last page
};

struct FacetCount {
  std::string name, value;
  std::uint64_t models = 0;
  bool operator==(const FacetCount&) const = default;
};

struct Facets {
  std::uint64_t models = 0;  // number of all models that the query finds
  // For each facet, in the order of the names, its most frequent values among these models.
  std::vector<FacetCount> counts = {};
};

// The place of a published model in the order in which harvesters read the catalogue: by the time
// of the last change, then by ID.
struct HarvestPlace {
  std::int64_t changed = 0;  // seconds since 1970, UTC
  ModelId model;
  bool operator==(const HarvestPlace&) const = default;
};

struct HarvestQuery {
  std::optional<ModelId> model = {};                  // only this model
  std::optional<std::int64_t> from = {}, until = {};  // range of `changed`, both inclusive
  std::string collection = {};                        // only models of this collection; empty: all
  std::optional<HarvestPlace> after = {};  // place of the last model of the previous page
  std::uint32_t limit = 50;                // 1..kMaxPage
};

struct HarvestedModel {
  ModelRecord model;
  std::int64_t changed = 0;
};

struct Harvest {
  std::vector<HarvestedModel> models;
  std::uint64_t all = 0;  // number of models on all pages; 0 if the query has `after`
  std::int64_t now = 0;   // time at which the rows were read, by the same clock as `changed`
};

// Safe to use from several threads at once, and by several processes on the same data. All
// functions fail with kIo if the database fails and with kLimit if the disk is full. The comments
// of the functions state when they fail with kState.
class Catalogue {
 public:
  virtual ~Catalogue() = default;

  // Adds a model and its chunks in one transaction. If `by` is given, the same transaction stores
  // the model's ID in the record of that job. Fails with kState if a model with this ID exists, or
  // if another daemon has claimed the job.
  virtual Expected<void> add(const ModelRecord& model, std::span<const ChunkPlace> chunks,
                             const std::optional<JobClaim>& by = std::nullopt) = 0;

  // Publishes a model or makes it a draft. Fails with kState if the model does not exist.
  virtual Expected<void> set_state(const ModelId& id, ModelState state) = 0;

  // Replaces the record of a model, except `created`, and increments its version. If `chunks` are
  // given, also replaces the model's chunks. If `by` is given, the same transaction stores the
  // model's ID in the record of that job. Fails with kState if the model does not exist, or if its
  // version is not `model.version` because another caller has changed the model.
  virtual Expected<void> update(const ModelRecord& model,
                                std::optional<std::span<const ChunkPlace>> chunks,
                                const std::optional<JobClaim>& by = std::nullopt) = 0;

  // Removes a model and its chunks. Fails with kState if the model does not exist, or if `version`
  // is given and is not the model's version.
  virtual Expected<void> remove(const ModelId& id, std::optional<std::uint64_t> version) = 0;

  // Returns the files of all models, drafts included, ordered by model. For each model, lists its
  // file, then the file of its public part if it has one.
  virtual Expected<std::vector<NamedFile>> files() = 0;

  virtual Expected<std::optional<ModelRecord>> find(const ModelId& id) = 0;  // finds drafts, too

  // Returns the newest published model with the same file and the same metadata as `model`, or
  // nullopt.
  virtual Expected<std::optional<ModelRecord>> find_same(const ModelRecord& model) = 0;

  // Returns one page of the models found. The page is empty if the models are ordered by title or
  // creator and the model `query.after` was removed meanwhile.
  virtual Expected<ModelPage> search(const ModelQuery& query) = 0;

  // Lists the published models, newest first, in pages of `size`, and returns the cursors of all
  // pages except the first. Reads only the IDs of the models.
  virtual Expected<std::vector<ModelId>> page_cursors(std::uint32_t size) = 0;

  // Counts the facet values of all models that the query finds, on all pages.
  virtual Expected<Facets> facets(const ModelQuery& query) = 0;

  // Returns published models, those first whose last change was earliest. A model that changes
  // while a harvester reads the pages moves to the end, so the harvester does not miss it.
  virtual Expected<Harvest> harvest(const HarvestQuery& query) = 0;

  // Returns the collections of all published models, ordered by the bytes of their names.
  virtual Expected<std::vector<std::string>> collections() = 0;

  // Returns the location of a chunk's bytes, or nullopt if no published model has the chunk.
  Expected<std::optional<ChunkLocation>> find_chunk(const Sha256& chunk) {
    return find_chunk_after(chunk, ModelId());
  }
  // Like find_chunk(), but considers only models whose ID is greater than `after`. Returns the
  // location in the model with the smallest ID.
  virtual Expected<std::optional<ChunkLocation>> find_chunk_after(const Sha256& chunk,
                                                                  const ModelId& after) = 0;

  // Returns the blocks that visitors can request of a published model. The result is empty if the
  // model is a draft or does not exist.
  virtual Expected<std::vector<Sha256>> public_chunks(const ModelId& id) = 0;

  // Adds a token. Fails with kState if a token with this ID or this hash exists.
  virtual Expected<void> add_token(const TokenRecord& token) = 0;

  // Returns the tokens that are not revoked and whose hashes start with the same four bytes as
  // `hash`. The caller compares the remaining bytes in constant time.
  virtual Expected<std::vector<TokenRecord>> tokens_like(const Sha256& hash) = 0;

  // Returns the tokens that are not revoked, oldest first.
  virtual Expected<std::vector<TokenRecord>> tokens() = 0;

  // Revokes a token; this cannot be undone. Fails with kState if the token does not exist or is
  // already revoked.
  virtual Expected<void> revoke_token(const TokenId& id) = 0;

  // Returns a number that changes whenever a process changes models or tokens. The call is cheap.
  // Data cached from the catalogue is valid as long as the number stays the same.
  virtual Expected<std::uint64_t> revision() = 0;

  // Sets the function that this object calls after it has withdrawn or removed a published model,
  // or replaced the model's chunks. The function receives the model's previous chunks, some of
  // which other published models may still have. Call when_hidden() before other threads use the
  // catalogue.
  using ChunksHidden = std::function<void(std::vector<Sha256> chunks)>;
  virtual void when_hidden(ChunksHidden hidden) = 0;
};

}  // namespace vitrine::server
