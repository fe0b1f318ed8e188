// SPDX-License-Identifier: Apache-2.0
#include "codec/gltf/gltf_resources.h"

#include "codec/gltf/data_uri.h"
#include "codec/repair/raw_mesh.h"

namespace vitrine::inline codec {

Expected<std::span<const std::uint8_t>> GltfResources::find(std::string_view uri) {
  if (is_data_uri(uri)) {
    auto bytes = data_in_uri(uri);
    if (!bytes) return bad_input("is a data: URI that is not base64; export the file again");
    return decoded_.emplace_back(*std::move(bytes));
  }
  const std::string path = percent_decoded(uri);
  const auto bytes = find_companion(companions_, path);
  if (!bytes) {
    return bad_input("is the file " + in_quotes(path) +
                     ", which is not beside the mesh file; copy it there, or export GLB with all "
                     "in one file");
  }
  if (found_.insert(companion_key(path)).second) bytes_ += bytes->size();
  return *bytes;
}

}  // namespace vitrine::inline codec
