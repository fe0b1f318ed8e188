// SPDX-License-Identifier: Apache-2.0
#include "server/store/publish.h"

#include <chrono>

#include "server/store/published_model.h"
#include "server/store/text.h"

namespace vitrine {
namespace {

std::int64_t now_in_milliseconds() {
  return std::chrono::duration_cast<std::chrono::milliseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

ModelRecord describe(const Manifest& manifest, const ModelMetadata& metadata, const PublishAs& as,
                     const Sha256& file) {
  ModelRecord record;
  record.id = as.id.value_or(ModelId::generate());
  record.state = as.state;
  record.created = now_in_milliseconds();
  record.title = metadata.title;
  record.creator = metadata.creator;
  record.rights = metadata.rights;
  record.licence = metadata.licence;
  record.unit = manifest.unit;
  record.file = file;
  record.file_bytes = manifest.file_bytes;
  record.head_bytes = manifest.head_bytes();
  record.faces = manifest.levels.back().faces;
  record.vertices = manifest.levels.back().vertices;
  return record;
}

std::vector<ChunkPlace> places(const Manifest& manifest) {
  std::vector<ChunkPlace> result;
  result.reserve(manifest.chunks.size() + 1);
  result.push_back({manifest.base_sha256, manifest.base_offset, manifest.base_length});
  for (const ChunkInfo& c : manifest.chunks)
    result.push_back({c.sha256, c.offset, c.length});
  return result;
}

Expected<void> check_text(const char* name, const std::string& text) {
  constexpr std::size_t kMaxBytes = 4096;
  if (text.size() <= kMaxBytes && is_plain_text(text)) return {};
  return fail(ErrorCode::kBadInput, std::string("the ") + name +
                                        " is not one line of UTF-8 of at most 4096 bytes; give "
                                        "another");
}

Expected<void> check_texts(const ModelMetadata& metadata, const std::string& unit) {
  if (auto good = check_text("title", metadata.title); !good) return good;
  if (auto good = check_text("creator", metadata.creator); !good) return good;
  if (auto good = check_text("rights statement", metadata.rights); !good) return good;
  if (auto good = check_text("licence", metadata.licence); !good) return good;
  return check_text("unit", unit);
}

Expected<void> check_size(const Manifest& manifest, std::uint64_t size) {
  if (manifest.file_bytes == size) return {};
  return fail(ErrorCode::kBadInput,
              "the file has " + std::to_string(size) + " bytes and its header says " +
                  std::to_string(manifest.file_bytes) + "; build or fetch it again");
}

// What a visitor would be served is what the header promises.
Expected<void> check_stored(const PublishedModel& model, std::span<const ChunkPlace> chunks) {
  for (const ChunkPlace& place : chunks) {
    const auto bytes = model.read({place.offset, place.length});
    if (!bytes) return tl::unexpected(bytes.error());
    if (sha256(*bytes) != place.chunk) {
      return fail(ErrorCode::kBadInput, "the chunk at byte " + std::to_string(place.offset) +
                                            " does not have its SHA-256; build the file again");
    }
  }
  return {};
}

// A draft is nobody's copy: only what is published already is not published again.
Expected<std::optional<ModelRecord>> find_earlier(Catalogue& catalogue, const ModelRecord& record) {
  auto same = catalogue.find(record.id);
  if (!same || *same || record.state == ModelState::kDraft) return same;
  return catalogue.find_same(record);
}

// Names the stored file in the catalogue, once it has been read back.
Expected<Publication> add(ObjectStore& store, Catalogue& catalogue, const ModelRecord& record) {
  const auto model = PublishedModel::open(store, record);
  if (!model) return tl::unexpected(model.error());
  const auto chunks = places((*model)->manifest());
  if (auto good = check_stored(**model, chunks); !good) return tl::unexpected(good.error());
  const auto same = find_earlier(catalogue, record);
  if (!same) return tl::unexpected(same.error());
  if (*same) return Publication{.id = (*same)->id, .is_new = false};
  if (auto added = catalogue.add(record, chunks); !added) return tl::unexpected(added.error());
  return Publication{.id = record.id};
}

}  // namespace

Expected<Publication> publish(ObjectStore& store, Catalogue& catalogue,
                              std::span<const std::uint8_t> pmesh, const ModelMetadata& metadata,
                              const PublishAs& as) {
  const auto manifest = parse_header(pmesh);
  if (!manifest) return tl::unexpected(manifest.error());
  if (auto good = check_texts(metadata, manifest->unit); !good) return tl::unexpected(good.error());
  if (auto fits = check_size(*manifest, pmesh.size()); !fits) return tl::unexpected(fits.error());
  const Sha256 name = sha256(pmesh);
  const auto lock = store.lock();
  if (!lock) return tl::unexpected(lock.error());
  const auto before = store.open(name);
  if (!before) return tl::unexpected(before.error());
  if (auto stored = store.put(name, pmesh); !stored) return tl::unexpected(stored.error());
  auto published = add(store, catalogue, describe(*manifest, metadata, as, name));
  // The first fault is the one to tell: a full disk takes a removal.
  if (!published && *before == nullptr) static_cast<void>(store.remove(name));
  return published;
}

}  // namespace vitrine
