// SPDX-License-Identifier: Apache-2.0
#include "server/store/change.h"

#include <algorithm>

#include "server/store/model_file.h"
#include "server/store/published_model.h"
#include "server/store/stored_file.h"

namespace vitrine {
namespace {

using Bytes = std::vector<std::uint8_t>;

void describe(ModelRecord& record, const StoredFile& stored) {
  const Manifest& manifest = stored.manifest;
  record.file = stored.name;
  record.file_bytes = manifest.file_bytes;
  record.head_bytes = manifest.head_bytes();
  record.faces = manifest.levels.back().faces;
  record.vertices = manifest.levels.back().vertices;
  record.unit = manifest.unit;
}

PublicPart part_of(const StoredFile& stored, std::uint32_t max_level) {
  const Manifest& manifest = stored.manifest;
  return {.max_level = max_level,
          .file = stored.name,
          .file_bytes = manifest.file_bytes,
          .head_bytes = manifest.head_bytes(),
          .faces = manifest.levels.back().faces,
          .vertices = manifest.levels.back().vertices};
}

// Has `pmesh` be the file of `record`, and as much of it public as the record says; the chunks are
// those of what is public.
Expected<void> store_files(ObjectStore& store, Catalogue& catalogue, ModelRecord& record,
                           const Bytes& pmesh) {
  const auto whole = store_file(store, pmesh);
  if (!whole) return tl::unexpected(whole.error());
  describe(record, *whole);
  std::vector<ChunkPlace> chunks = whole->chunks();
  if (record.public_part) {
    const std::uint32_t level = record.public_part->max_level;
    const auto cut = with_header(pmesh, {.last_level = level, .unit = {}});
    if (!cut) return tl::unexpected(cut.error());
    const auto part = store_file(store, *cut);
    if (!part) return tl::unexpected(part.error());
    record.public_part = part_of(*part, level);
    chunks = part->chunks();
  }
  return catalogue.update(record, chunks);
}

Expected<Bytes> read_file(const ObjectStore& store, const ModelRecord& record) {
  const auto model = PublishedModel::open(store, record);
  if (!model) return tl::unexpected(model.error());
  return (*model)->read((*model)->whole());
}

void take_text(std::string& text, const std::string& given) {
  if (!given.empty()) text = given;
}

}  // namespace

ModelRecord public_view(ModelRecord record) {
  if (!record.public_part) return record;
  const PublicPart& part = *record.public_part;
  record.file = part.file;
  record.file_bytes = part.file_bytes;
  record.head_bytes = part.head_bytes;
  record.faces = part.faces;
  record.vertices = part.vertices;
  return record;
}

Expected<Publication> replace(ObjectStore& store, Catalogue& catalogue,
                              std::span<const std::uint8_t> pmesh, const ModelMetadata& metadata,
                              const PublishAs& as) {
  if (auto good = check_texts(metadata); !good) return tl::unexpected(good.error());
  const auto lock = store.lock();
  if (!lock) return tl::unexpected(lock.error());
  auto found = catalogue.find(as.id.value_or(ModelId()));
  if (!found) return tl::unexpected(found.error());
  if (!*found) return fail(ErrorCode::kState, "the model to replace is gone; publish a new one");
  ModelRecord record = std::move(**found);
  take_text(record.title, metadata.title);
  take_text(record.creator, metadata.creator);
  take_text(record.rights, metadata.rights);
  take_text(record.licence, metadata.licence);
  for (const auto& [name, text] : metadata.more)
    record.more[name] = text;
  if (as.state == ModelState::kPublished) record.state = as.state;
  if (auto done = store_files(store, catalogue, record, {pmesh.begin(), pmesh.end()}); !done)
    return tl::unexpected(done.error());
  return Publication{.id = record.id};
}

Expected<ModelRecord> change(ObjectStore& store, Catalogue& catalogue, const ModelRecord& wanted) {
  const auto lock = store.lock();
  if (!lock) return tl::unexpected(lock.error());
  const auto found = catalogue.find(wanted.id);
  if (!found) return tl::unexpected(found.error());
  if (!*found || (*found)->version != wanted.version)
    return fail(ErrorCode::kState, "the model was changed or removed meanwhile; read it again");
  const ModelRecord& before = **found;
  ModelRecord record = wanted;
  const auto level = [](const ModelRecord& m) {
    return m.public_part ? std::optional(m.public_part->max_level) : std::nullopt;
  };
  if (level(record) == level(before) && record.unit == before.unit) {
    record.public_part = before.public_part;
    if (auto done = catalogue.update(record, std::nullopt); !done)
      return tl::unexpected(done.error());
  } else {
    auto pmesh = read_file(store, before);
    if (pmesh && record.unit != before.unit)
      pmesh = with_header(*pmesh, {.last_level = {}, .unit = record.unit});
    if (!pmesh) return tl::unexpected(pmesh.error());
    if (auto done = store_files(store, catalogue, record, *pmesh); !done)
      return tl::unexpected(done.error());
  }
  ++record.version;
  return record;
}

}  // namespace vitrine
