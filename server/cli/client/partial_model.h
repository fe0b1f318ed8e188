// SPDX-License-Identifier: Apache-2.0
// A model that is being fetched. It is kept in a .pmesh file of full length in which missing chunks
// and pictures are holes. Hashes show which chunks and pictures the file contains, so a fetch can
// continue after any interruption.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "codec/core/expected.h"
#include "codec/files/file_descriptor.h"
#include "codec/format/file_blocks.h"
#include "server/stream/message.h"
#include "server/stream/slice.h"

namespace vitrine::server {

class PartialModel {
 public:
  // Creates the file, or opens the file that an earlier run left. Fails with kIo.
  static Expected<PartialModel> open(std::filesystem::path path);

  const std::filesystem::path& path() const { return path_; }
  // Returns nullopt until the model's head (Manifest::head_bytes()) has arrived.
  const std::optional<Manifest>& manifest() const { return manifest_; }
  bool holds(std::size_t chunk) const { return held_[chunk]; }
  // Whether picture number `i` of the texture is complete.
  bool holds_picture(std::size_t i) const { return held_pictures_[i]; }
  std::vector<ChunkRange> held_ranges() const;
  std::uint64_t bytes() const;  // size of the model's head and of the complete chunks and pictures
  // Returns the finest level that is complete in all regions.
  std::uint32_t level() const;

  // Adds a slice from an untrusted server. Fails with kBadInput if the slice fits no chunk of the
  // model or comes out of order, or if the chunk's hash is wrong. Allocates at most the chunk's
  // length, or kMaxHead for the head.
  Expected<void> add(const SliceHeader& header, std::span<const std::uint8_t> payload);

  // Adds picture number `i` of the texture, from an untrusted server. Fails with kBadInput if its
  // hash is wrong.
  Expected<void> add_picture(std::size_t i, std::span<const std::uint8_t> bytes);

  // Whether an optional block is complete. Reads the block from the file and checks its hash.
  bool holds(const OptionalBlock& block) const;
  // Adds an optional block, like add_picture().
  Expected<void> add(const OptionalBlock& block, std::span<const std::uint8_t> bytes);

  // Discards incomplete chunks. The next connection sends them again from the start.
  void forget_parts() { parts_.clear(); }

  static constexpr std::uint64_t kMaxHead = 256u << 20;

 private:
  using Bytes = std::vector<std::uint8_t>;
  struct Key {
    std::uint32_t level, region;
    auto operator<=>(const Key&) const = default;
  };

  PartialModel(std::filesystem::path path, FileDescriptor file)
      : path_(std::move(path)), file_(std::move(file)) {}

  Expected<void> take_up();
  Expected<void> set_head(const Bytes& head);
  Expected<std::uint64_t> length_of(const SliceHeader& header) const;
  Expected<void> complete(const Key& key, const Bytes& bytes);
  void look_for_parts();
  bool read_is_whole(const FileBlock& block) const;
  Expected<void> write(std::uint64_t offset, std::span<const std::uint8_t> bytes);
  Expected<Bytes> read(std::uint64_t offset, std::uint64_t length) const;

  std::filesystem::path path_;
  FileDescriptor file_;
  std::optional<Manifest> manifest_;
  std::vector<bool> held_, held_pictures_;
  std::map<Key, Bytes> parts_;  // received slices of incomplete chunks
};

}  // namespace vitrine::server
