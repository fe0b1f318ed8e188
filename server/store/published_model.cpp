// SPDX-License-Identifier: Apache-2.0
#include "server/store/published_model.h"

#include <fmt/core.h>

#include <algorithm>
#include <numeric>

#include "codec/format/file_blocks.h"

namespace vitrine::server {
namespace {

// Returns the indices of the chunks, sorted by SHA-256.
std::vector<std::uint32_t> by_name(const std::vector<ChunkInfo>& chunks) {
  std::vector<std::uint32_t> order(chunks.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::sort(order, {}, [&](std::uint32_t i) { return chunks[i].sha256; });
  return order;
}

}  // namespace

Unexpected PublishedModel::damaged(const ModelRecord& record, std::string_view why) {
  return fail(
      ErrorCode::kState,
      fmt::format("model {} cannot be served: {}; publish it again, or run 'vitrine repair'",
                  record.id.to_string(), why));
}

Expected<Manifest> PublishedModel::read_manifest(const Object& file, const ModelRecord& record) {
  const auto head = file.read(0, std::min(record.head_bytes, file.size()));
  if (!head) return tl::unexpected(head.error());
  auto manifest = parse_header(*head);
  if (!manifest) return damaged(record, manifest.error().message);
  if (manifest->file_bytes != file.size() || manifest->head_bytes() != record.head_bytes)
    return damaged(record, "the length of its file differs from the length in the header");
  return manifest;
}

Sha256 geometry_hash(const Manifest& manifest) {
  std::vector<std::uint8_t> names(manifest.base_sha256.begin(), manifest.base_sha256.end());
  for (const ChunkInfo& chunk : manifest.chunks)
    names.insert(names.end(), chunk.sha256.begin(), chunk.sha256.end());
  return sha256(names);
}

Expected<std::shared_ptr<const PublishedModel>> PublishedModel::open(const ObjectStore& store,
                                                                     ModelRecord record,
                                                                     std::uint64_t damages) {
  auto file = store.open(record.file);
  if (!file && file.error().code == ErrorCode::kState)
    return damaged(record, "its file " + to_hex(record.file) + " is damaged");
  if (!file) return tl::unexpected(file.error());
  if (!*file) return damaged(record, "its file is missing from the store");
  auto manifest = read_manifest(**file, record);
  if (!manifest) return tl::unexpected(manifest.error());
  std::shared_ptr<PublishedModel> model(new PublishedModel);
  model->record_ = std::move(record);
  model->manifest_ = std::move(*manifest);
  model->by_name_ = by_name(model->manifest_.chunks);
  model->file_ = std::move(*file);
  model->damages_ = damages;
  return model;
}

std::optional<ByteRange> PublishedModel::find(const Sha256& sha256) const {
  std::optional<ByteRange> beside;
  for_each_block_beside_chunks(manifest_, [&](const FileBlock& block) {
    if (block.sha256 == sha256) beside = {block.offset, block.length};
  });
  if (beside) return beside;
  const auto name_of = [this](std::uint32_t i) { return manifest_.chunks[i].sha256; };
  const auto found = std::ranges::lower_bound(by_name_, sha256, {}, name_of);
  if (found == by_name_.end() || name_of(*found) != sha256) return std::nullopt;
  return chunk(*found);
}

}  // namespace vitrine::server
