// SPDX-License-Identifier: Apache-2.0
// Finds the data to which a glTF file refers by URI: in the URI itself, or in a companion file.
#pragma once

#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "codec/core/expected.h"
#include "codec/files/companions.h"
#include "codec/gltf/gltf_json.h"

namespace vitrine::inline codec {

class GltfResources {
 public:
  // `companions` must outlive this object. `file_bytes` is the size of the glTF file.
  GltfResources(const Companions& companions, std::uint64_t file_bytes)
      : companions_(companions), bytes_(file_bytes) {}

  // Returns the data of a URI. The data is valid as long as this object. If the URI is a path,
  // percent-decodes the path and finds its file by find_companion(). Fails (kBadInput) with a fault
  // and a next step; the caller adds the place.
  Expected<std::span<const std::uint8_t>> find(std::string_view uri);

  // Returns the total size in bytes of the glTF file and of the companions found so far.
  std::uint64_t bytes() const { return bytes_; }

 private:
  const Companions& companions_;
  std::set<std::string> found_;                     // keys of the companions found so far
  std::vector<std::vector<std::uint8_t>> decoded_;  // contents of data: URIs
  std::uint64_t bytes_;
};

// Returns the name_key() of each file to which a glTF document refers: buffers and pictures.
std::set<std::string> names_of_files(const Json& document);

}  // namespace vitrine::inline codec
