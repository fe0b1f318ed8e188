// SPDX-License-Identifier: Apache-2.0
#include "server/store/stored_file.h"

namespace vitrine::server {
namespace {

Expected<void> check_size(const Manifest& manifest, std::uint64_t size) {
  if (manifest.file_bytes == size) return {};
  return fail(ErrorCode::kBadInput,
              "the file has " + std::to_string(size) + " bytes and its header says " +
                  std::to_string(manifest.file_bytes) + "; build or fetch it again");
}

Expected<void> check_stored(const ObjectStore& store, const StoredFile& file) {
  const auto object = store.open(file.name);
  if (!object) return tl::unexpected(object.error());
  if (*object == nullptr)
    return fail(ErrorCode::kIo, "the stored file has disappeared; check the data folder");
  for (const ChunkPlace& place : file.chunks()) {
    const auto bytes = (*object)->read(place.offset, place.length);
    if (!bytes) return tl::unexpected(bytes.error());
    if (sha256(*bytes) != place.chunk) {
      return fail(ErrorCode::kBadInput, "the chunk at byte " + std::to_string(place.offset) +
                                            " does not have its SHA-256; build the file again");
    }
  }
  return {};
}

}  // namespace

std::vector<ChunkPlace> StoredFile::chunks() const {
  std::vector<ChunkPlace> result;
  result.reserve(manifest.chunks.size() + 1);
  result.push_back({manifest.base_sha256, manifest.base_offset, manifest.base_length});
  for (const ChunkInfo& c : manifest.chunks)
    result.push_back({c.sha256, c.offset, c.length});
  return result;
}

Expected<StoredFile> to_be_stored(std::span<const std::uint8_t> pmesh) {
  auto manifest = parse_header(pmesh);
  if (!manifest) return tl::unexpected(manifest.error());
  if (auto fits = check_size(*manifest, pmesh.size()); !fits) return tl::unexpected(fits.error());
  return StoredFile{.name = sha256(pmesh), .manifest = std::move(*manifest)};
}

Expected<void> store_file(ObjectStore& store, StoredFile& file,
                          std::span<const std::uint8_t> pmesh) {
  const auto before = store.open(file.name);
  if (!before) return tl::unexpected(before.error());
  const auto written = store.put(file.name, pmesh);
  if (!written) return tl::unexpected(written.error());
  file.is_new = *before == nullptr;
  file.is_repaired = *written && !file.is_new;
  auto checked = check_stored(store, file);
  // Ignores an error of the removal, because the check's error is the one to report. The removal
  // works even on a full disk.
  if (!checked && file.is_new) static_cast<void>(store.remove(file.name));
  return checked;
}

void describe(ModelRecord& record, const StoredFile& file) {
  const Manifest& manifest = file.manifest;
  record.file = file.name;
  record.file_bytes = manifest.file_bytes;
  record.head_bytes = manifest.head_bytes();
  record.faces = manifest.levels.back().faces;
  record.vertices = manifest.levels.back().vertices;
  record.unit = manifest.unit;
}

}  // namespace vitrine::server
