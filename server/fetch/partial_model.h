// SPDX-License-Identifier: Apache-2.0
// A model on its way: a .pmesh of full length in which the chunks that have not come are holes.
// What it holds, hashes tell: so it survives any end of the program that writes it.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "codec/core/expected.h"
#include "codec/files/file_descriptor.h"
#include "codec/progressive/manifest.h"
#include "server/stream/message.h"
#include "server/stream/slice.h"

namespace vitrine {

class PartialModel {
 public:
  // Creates the file or takes up what an earlier run has left there. Fails with kIo.
  static Expected<PartialModel> open(std::filesystem::path path);

  const std::filesystem::path& path() const { return path_; }
  // Nothing until the head is there.
  const std::optional<Manifest>& manifest() const { return manifest_; }
  bool holds(std::size_t chunk) const { return held_[chunk]; }
  std::vector<ChunkRange> held_ranges() const;
  std::uint64_t bytes() const;  // of the head and the chunks held
  // The finest level that is there everywhere.
  std::uint32_t level() const;

  // Takes in a slice of a hostile server: fails with kBadInput where it fits no chunk of the model,
  // comes out of order, or the chunk is not the one that the head names. Allocates at most the
  // chunk's length, for heads kMaxHead.
  Expected<void> add(const SliceHeader& header, std::span<const std::uint8_t> payload);

  // Slices of chunks that are not whole are forgotten: the next connection sends them anew.
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
  bool read_is_whole(std::size_t chunk) const;
  Expected<void> write(std::uint64_t offset, std::span<const std::uint8_t> bytes);
  Expected<Bytes> read(std::uint64_t offset, std::uint64_t length) const;

  std::filesystem::path path_;
  FileDescriptor file_;
  std::optional<Manifest> manifest_;
  std::vector<bool> held_;
  std::map<Key, Bytes> parts_;  // of chunks that are not whole: what has come
};

}  // namespace vitrine
