// SPDX-License-Identifier: Apache-2.0
#include "server/store/stored_file.h"

#include <algorithm>
#include <bitset>

#include "codec/format/file_blocks.h"

namespace vitrine::server {
namespace {

Expected<void> check_size(const Manifest& manifest, std::uint64_t size) {
  if (manifest.file_bytes == size) return {};
  return fail(ErrorCode::kBadInput,
              "the file has " + std::to_string(size) + " bytes and its header says " +
                  std::to_string(manifest.file_bytes) + "; build or fetch it again");
}

Expected<void> check_blocks(const StoredFile& file, std::span<const std::uint8_t> pmesh) {
  for (const ChunkPlace& place : file.blocks()) {
    const bool is_inside =
        place.offset <= pmesh.size() && place.length <= pmesh.size() - place.offset;
    if (!is_inside || sha256(pmesh.subspan(place.offset, place.length)) != place.chunk) {
      return fail(ErrorCode::kBadInput, "the part at byte " + std::to_string(place.offset) +
                                            " does not have its SHA-256; build the file again");
    }
  }
  return {};
}

// Does not open the object, because a store in a bucket would then copy it to the disk.
Expected<void> check_stored(const ObjectStore& store, const StoredFile& file) {
  const auto state = store.check(file.name, [](std::uint64_t) { return true; });
  if (!state) return tl::unexpected(state.error());
  if (*state == ObjectState::kIntact) return {};
  return fail(ErrorCode::kIo,
              "the stored file is damaged or missing; check the disk or the bucket, and try again");
}

}  // namespace

std::vector<ChunkPlace> StoredFile::blocks() const {
  std::vector<ChunkPlace> result;
  result.reserve(manifest.chunks.size() + 1);
  for_each_block(manifest, [&](const FileBlock& block) {
    result.push_back({block.sha256, block.offset, block.length});
  });
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
  if (auto good = check_blocks(file, pmesh); !good) return good;
  const auto before = store.size_of(file.name);
  if (!before) return tl::unexpected(before.error());
  const auto written = store.put(file.name, pmesh);
  if (!written) return tl::unexpected(written.error());
  file.is_new = !*before;
  file.is_repaired = *written && !file.is_new;
  auto checked = check_stored(store, file);
  // Ignores an error of the removal, because the check's error is the one to report. Removing the
  // object is possible even if the disk is full.
  if (!checked && file.is_new) static_cast<void>(store.remove(file.name));
  return checked;
}

TextureSummary summary_of(const TextureInfo& texture) {
  TextureSummary summary;
  std::bitset<kPictureRoles> roles;
  for (const PictureInfo& picture : texture.pictures) {
    roles.set(static_cast<std::size_t>(picture.role));
    summary.largest_side = std::max(summary.largest_side, picture.side);
    summary.bytes += picture.length;
  }
  summary.count = static_cast<std::uint32_t>(roles.count());
  return summary;
}

void describe(ModelRecord& record, const StoredFile& file) {
  const Manifest& manifest = file.manifest;
  record.file = file.name;
  record.file_bytes = manifest.file_bytes;
  record.head_bytes = manifest.head_bytes();
  record.faces = manifest.levels.back().faces;
  record.vertices = manifest.levels.back().vertices;
  record.textures = summary_of(manifest.texture);
  record.unit = manifest.unit;
}

}  // namespace vitrine::server
