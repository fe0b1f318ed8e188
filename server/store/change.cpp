// SPDX-License-Identifier: Apache-2.0
#include "server/store/change.h"

#include <algorithm>

#include "codec/build/open_model.h"
#include "server/store/model_file.h"
#include "server/store/published_model.h"
#include "server/store/stored_file.h"

namespace vitrine::server {
namespace {

using Bytes = std::vector<std::uint8_t>;

PublicPart part_of(const StoredFile& stored, std::uint32_t max_level) {
  const Manifest& manifest = stored.manifest;
  return {.max_level = max_level,
          .file = stored.name,
          .file_bytes = manifest.file_bytes,
          .head_bytes = manifest.head_bytes(),
          .faces = manifest.levels.back().faces,
          .vertices = manifest.levels.back().vertices,
          .textures = summary_of(manifest.texture)};
}

// Starts the grace period of a model's files, during which the store keeps them although no model
// refers to them. Call this before removing the references to the files, because a reader may have
// read the record but not opened the files yet.
Expected<void> let_go(ObjectStore& store, const ModelRecord& record) {
  if (auto begun = store.begin_grace(record.file); !begun || !record.public_part) return begun;
  return store.begin_grace(record.public_part->file);
}

Expected<Bytes> read_file(const ObjectStore& store, const ModelRecord& record) {
  const auto model = PublishedModel::open(store, record);
  if (!model) return tl::unexpected(model.error());
  return (*model)->read((*model)->whole());
}

// Sets Presentation::turned_box, the bounding box of the rotated vertices, unless the bounding box
// of the file determines it. If the model has more than kMostMeasured triangles, measures it at a
// coarser level of detail, whose box is nearly the same.
Expected<void> measure_turned(Presentation& presentation, std::span<const std::uint8_t> pmesh) {
  constexpr std::uint64_t kMostMeasured = 1'000'000;
  const PresentationTransform placement(presentation);
  presentation.turned_box.reset();
  if (placement.keeps_axes()) return {};
  auto refiner = open_model(pmesh);
  if (!refiner) return tl::unexpected(refiner.error());
  const ChunkReader chunks = chunks_of(refiner->manifest(), pmesh);
  if (auto done = refine(*refiner, WantTriangles{kMostMeasured}, chunks); !done) return done;
  std::vector<Vec3> points = refiner->display_mesh().positions;
  if (points.empty()) return {};
  for (Vec3& point : points)
    point = placement.turned(point);
  presentation.turned_box = bounds_of(points);
  return {};
}

// A .pmesh file that will be stored.
struct FileToStore {
  Bytes bytes;
  StoredFile file;
};

// Returns the public part of `pmesh`, or nullopt if the whole model is public.
Expected<std::optional<FileToStore>> public_part(const ModelRecord& record,
                                                 std::span<const std::uint8_t> pmesh) {
  if (!record.public_part) return std::nullopt;
  auto cut = with_header(pmesh, {.last_level = record.public_part->max_level, .unit = {}});
  if (!cut) return tl::unexpected(cut.error());
  auto file = to_be_stored(*cut);
  if (!file) return tl::unexpected(file.error());
  return FileToStore{std::move(*cut), std::move(*file)};
}

// Stores `pmesh` and its public part, which `record` defines, as the model's files. Updates the
// catalogue from `before` to `record`. The catalogue gets only the blocks that visitors may see.
Expected<void> store_files(ObjectStore& store, Catalogue& catalogue, const ExclusiveLock& lock,
                           const ModelRecord& before, ModelRecord& record,
                           std::span<const std::uint8_t> pmesh, const PublishAs& as) {
  auto whole = to_be_stored(pmesh);
  if (!whole) return tl::unexpected(whole.error());
  auto part = public_part(record, pmesh);
  if (!part) return tl::unexpected(part.error());
  std::vector<NamedFile> files = {{record.id, whole->name, pmesh.size()}};
  if (*part) files.push_back({record.id, (*part)->file.name, (*part)->bytes.size()});
  const auto room = Quota::reserve(as.quota, files, as.upload);
  if (!room) return tl::unexpected(room.error());

  if (auto stored = store_file(store, *whole, pmesh); !stored) return stored;
  describe(record, *whole);
  if (*part) {
    if (auto stored = store_file(store, (*part)->file, (*part)->bytes); !stored) return stored;
    record.public_part = part_of((*part)->file, record.public_part->max_level);
  }
  if (auto begun = let_go(store, before); !begun) return begun;
  if (auto held = lock.check(); !held) return held;
  return catalogue.update(record, (*part ? (*part)->file : *whole).blocks(), as.by);
}

void take_text(std::string& text, const std::string& given) {
  if (!given.empty()) text = given;
}

// Returns the record with the texts that `metadata` contains; other texts stay.
ModelRecord with_texts(ModelRecord record, const ModelMetadata& metadata) {
  take_text(record.title, metadata.title);
  take_text(record.creator, metadata.creator);
  take_text(record.rights, metadata.rights);
  take_text(record.licence, metadata.licence);
  for (const auto& [name, text] : metadata.more)
    record.more[name] = text;
  return record;
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
  record.textures = part.textures;
  return record;
}

Expected<Publication> replace(ObjectStore& store, Catalogue& catalogue,
                              std::span<const std::uint8_t> pmesh, const ModelMetadata& metadata,
                              const PublishAs& as) {
  if (auto good = check_texts(metadata); !good) return tl::unexpected(good.error());
  const auto lock = store.lock();
  if (!lock) return tl::unexpected(lock.error());
  std::optional<Error> refused;  // error of the last attempt
  for (std::uint64_t tried = 0;;) {
    const auto found = catalogue.find(as.id.value_or(ModelId()));
    if (!found) return tl::unexpected(found.error());
    if (!*found) return fail(ErrorCode::kState, "the model to replace is gone; publish a new one");
    if (refused && (*found)->version == tried) return tl::unexpected(*refused);
    ModelRecord record = with_texts(**found, metadata);
    record.repairs = as.repairs;
    if (as.state == ModelState::kPublished) record.state = as.state;
    if (auto measured = measure_turned(record.presentation, pmesh); !measured)
      return tl::unexpected(measured.error());
    const auto done = store_files(store, catalogue, **lock, **found, record, pmesh, as);
    if (done) return Publication{.id = record.id};
    // Catalogue::set_state() needs no lock of the store, so another caller may have changed the
    // model in the meantime. The loop then tries again with the new version.
    if (done.error().code != ErrorCode::kState) return tl::unexpected(done.error());
    refused = done.error();
    tried = (*found)->version;
  }
}

Expected<void> remove(ObjectStore& store, Catalogue& catalogue, const ModelId& id,
                      std::optional<std::uint64_t> version) {
  const auto lock = store.lock();
  if (!lock) return tl::unexpected(lock.error());
  const auto found = catalogue.find(id);
  if (!found) return tl::unexpected(found.error());
  if (*found) {
    if (auto begun = let_go(store, **found); !begun) return begun;
  }
  return catalogue.remove(id, version);
}

Expected<ModelRecord> change(ObjectStore& store, Catalogue& catalogue, const ModelRecord& wanted,
                             Quota* quota) {
  const auto lock = store.lock();
  if (!lock) return tl::unexpected(lock.error());
  const auto found = catalogue.find(wanted.id);
  if (!found) return tl::unexpected(found.error());
  if (!*found || (*found)->version != wanted.version)
    return fail(ErrorCode::kState, "the model was changed or removed meanwhile; read it again");
  const ModelRecord& before = **found;
  ModelRecord record = wanted;
  if (record.presentation.rotation != before.presentation.rotation) {
    const auto pmesh = read_file(store, before);
    if (!pmesh) return tl::unexpected(pmesh.error());
    if (auto measured = measure_turned(record.presentation, *pmesh); !measured)
      return tl::unexpected(measured.error());
  }
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
    if (auto done = store_files(store, catalogue, **lock, before, record, *pmesh, {.quota = quota});
        !done)
      return tl::unexpected(done.error());
  }
  ++record.version;
  return record;
}

}  // namespace vitrine::server
