// SPDX-License-Identifier: Apache-2.0
#include "server/cli/client/partial_model.h"

#include <fmt/core.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "codec/files/atomic_file.h"

namespace vitrine::server {
namespace {

Unexpected cannot(const char* what, const std::filesystem::path& path) {
  const int error = errno;
  return fail(ErrorCode::kIo, fmt::format("cannot {} {}: {}; {}", what, path.string(),
                                          std::strerror(error), next_step(error)));
}

Unexpected wrong(const char* why) {
  return fail(ErrorCode::kBadInput,
              fmt::format("the server {}; try again or ask its operator", why));
}

}  // namespace

Expected<PartialModel> PartialModel::open(std::filesystem::path path) {
  FileDescriptor file(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644));
  if (!file) return cannot("open", path);
  PartialModel model(std::move(path), std::move(file));
  if (auto taken = model.take_up(); !taken) return tl::unexpected(taken.error());
  return model;
}

// Continues with the content of an existing file. If the content has no valid head, it will be
// overwritten.
Expected<void> PartialModel::take_up() {
  struct stat status {};
  if (::fstat(file_.get(), &status) != 0) return cannot("read", path_);
  if (status.st_size < static_cast<off_t>(kHeaderPrefix)) return {};
  const auto prefix = read(0, kHeaderPrefix);
  const auto length = prefix ? header_bytes(*prefix) : tl::unexpected(prefix.error());
  if (!length || *length > Limits{}.header_bytes) return {};
  const auto header = read(0, *length);
  const auto manifest = header ? parse_header(*header) : tl::unexpected(header.error());
  if (!manifest || manifest->head_bytes() > kMaxHead) return {};
  const auto head = read(0, manifest->head_bytes());
  if (!head || !is_intact_head(*manifest, *head)) return {};
  manifest_ = *manifest;
  look_for_parts();
  return {};
}

// Finds out which chunks and pictures the file contains.
void PartialModel::look_for_parts() {
  held_.clear();
  held_pictures_.clear();
  for (const ChunkInfo& chunk : manifest_->chunks)
    held_.push_back(read_is_whole({chunk.sha256, chunk.offset, chunk.length}));
  for (const PictureInfo& picture : manifest_->texture.pictures)
    held_pictures_.push_back(read_is_whole({picture.sha256, picture.offset, picture.length}));
}

bool PartialModel::read_is_whole(const FileBlock& block) const {
  const auto bytes = read(block.offset, block.length);
  return bytes && sha256(*bytes) == block.sha256;
}

std::vector<ChunkRange> PartialModel::held_ranges() const {
  std::vector<ChunkRange> ranges;
  for (std::size_t i = 0; i < held_.size(); ++i) {
    if (!held_[i]) continue;
    if (!ranges.empty() && ranges.back().last + 1 == i) {
      ranges.back().last = i;
    } else {
      ranges.push_back({i, i});
    }
  }
  return ranges;
}

std::uint64_t PartialModel::bytes() const {
  if (!manifest_) return 0;
  std::uint64_t bytes = manifest_->head_bytes();
  for (std::size_t i = 0; i < held_.size(); ++i) {
    if (held_[i]) bytes += manifest_->chunks[i].length;
  }
  const TextureInfo& texture = manifest_->texture;
  for (std::size_t i = texture.in_head; i < held_pictures_.size(); ++i) {
    if (held_pictures_[i]) bytes += texture.pictures[i].length;
  }
  return bytes;
}

std::uint32_t PartialModel::level() const {
  const auto missing = std::ranges::find(held_, false);
  if (missing == held_.end()) return static_cast<std::uint32_t>(manifest_->levels.size() - 1);
  return manifest_->chunks[static_cast<std::size_t>(missing - held_.begin())].level - 1;
}

Expected<std::uint64_t> PartialModel::length_of(const SliceHeader& header) const {
  if (header.level == 0) {
    if (header.region != 0 || header.total > kMaxHead) return wrong("does not send a head");
    return header.total;
  }
  if (!manifest_) return wrong("sends chunks before the head");
  const std::size_t chunk =
      header.level < manifest_->levels.size() && header.region < manifest_->tree.leaves()
          ? manifest_->find_chunk(header.level, header.region)
          : manifest_->chunks.size();
  if (chunk == manifest_->chunks.size() || manifest_->chunks[chunk].region != header.region ||
      manifest_->chunks[chunk].length != header.total) {
    return wrong("sends a chunk that the model does not have");
  }
  return header.total;
}

Expected<void> PartialModel::add(const SliceHeader& header, std::span<const std::uint8_t> payload) {
  const auto total = length_of(header);
  if (!total) return tl::unexpected(total.error());
  const Key key{header.level, header.region};
  Bytes& part = parts_[key];
  if (part.size() != header.offset || payload.size() > *total - part.size()) {
    return wrong("sends slices out of order");
  }
  part.insert(part.end(), payload.begin(), payload.end());
  if (part.size() < *total) return {};
  const Bytes whole = std::move(part);
  parts_.erase(key);
  return complete(key, whole);
}

Expected<void> PartialModel::complete(const Key& key, const Bytes& bytes) {
  if (key.level == 0) return set_head(bytes);
  const std::size_t chunk = manifest_->find_chunk(key.level, key.region);
  const ChunkInfo& info = manifest_->chunks[chunk];
  if (sha256(bytes) != info.sha256) return wrong("sends a damaged chunk (SHA-256 differs)");
  if (auto written = write(info.offset, bytes); !written) return written;
  held_[chunk] = true;
  return {};
}

Expected<void> PartialModel::set_head(const Bytes& head) {
  auto manifest = parse_header(head);
  if (!manifest) return wrong("sends a malformed head");
  if (!is_intact_head(*manifest, head)) return wrong("sends a damaged head");
  // An existing head cannot differ from this one, because the file's name contains the model's
  // hash.
  if (manifest_) return {};
  if (::ftruncate(file_.get(), 0) != 0 ||
      ::ftruncate(file_.get(), static_cast<off_t>(manifest->file_bytes)) != 0) {
    return cannot("write", path_);
  }
  if (auto written = write(0, head); !written) return written;
  held_.assign(manifest->chunks.size(), false);
  held_pictures_.assign(manifest->texture.pictures.size(), false);
  std::fill_n(held_pictures_.begin(), manifest->texture.in_head, true);
  manifest_ = std::move(*manifest);
  return {};
}

Expected<void> PartialModel::add_picture(std::size_t i, std::span<const std::uint8_t> bytes) {
  const PictureInfo& picture = manifest_->texture.pictures[i];
  if (sha256(bytes) != picture.sha256) return wrong("sends a damaged picture (SHA-256 differs)");
  if (auto written = write(picture.offset, bytes); !written) return written;
  held_pictures_[i] = true;
  return {};
}

bool PartialModel::holds(const OptionalBlock& block) const {
  return read_is_whole({block.sha256, block.offset, block.length});
}

Expected<void> PartialModel::add(const OptionalBlock& block, std::span<const std::uint8_t> bytes) {
  if (sha256(bytes) == block.sha256) return write(block.offset, bytes);
  return wrong("sends a damaged original (SHA-256 differs)");
}

Expected<void> PartialModel::write(std::uint64_t offset, std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t count =
        ::pwrite(file_.get(), bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return cannot("write", path_);
    offset += static_cast<std::uint64_t>(count);
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return {};
}

Expected<PartialModel::Bytes> PartialModel::read(std::uint64_t offset, std::uint64_t length) const {
  struct stat status {};
  if (::fstat(file_.get(), &status) != 0) return cannot("read", path_);
  const auto size = static_cast<std::uint64_t>(status.st_size);
  if (offset > size || length > size - offset)
    return fail(ErrorCode::kBadInput, "the range is beyond the end");
  Bytes bytes(length);
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count = ::pread(file_.get(), bytes.data() + done, bytes.size() - done,
                                  static_cast<off_t>(offset + done));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return cannot("read", path_);
    done += static_cast<std::size_t>(count);
  }
  return bytes;
}

}  // namespace vitrine::server
