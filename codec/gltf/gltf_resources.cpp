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
  const auto found = find_companion(companions_, {path});
  if (!found)
    return bad_input("is the file " + in_quotes(path) + ", which " + found.error().message);
  const auto& [key, bytes] = **found;
  if (found_.insert(key).second) bytes_ += bytes.size();
  return bytes;
}

std::set<std::string> names_of_files(const Json& document) {
  std::set<std::string> names;
  for (const char* list : {"buffers", "images"}) {
    for (const Json& entry : member(document, list)) {
      const std::string uri = text(entry, "uri", "");
      if (!uri.empty() && !is_data_uri(uri)) names.insert(name_key(percent_decoded(uri)));
    }
  }
  return names;
}

}  // namespace vitrine::inline codec
