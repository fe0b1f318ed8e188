// SPDX-License-Identifier: Apache-2.0
#include "codec/gltf/gltf_pictures.h"

#include <algorithm>

#include "codec/gltf/data_uri.h"
#include "codec/repair/raw_mesh.h"

namespace vitrine::inline codec {

Expected<std::span<const std::uint8_t>> GltfPictures::bytes(std::uint64_t index) {
  if (const auto known = found_.find(index); known != found_.end()) return known->second;
  const auto bytes = find(index);
  if (bytes) found_.emplace(index, *bytes);
  return bytes;
}

Expected<std::span<const std::uint8_t>> GltfPictures::find(std::uint64_t index) {
  const Json& self = element(document_, "images", index);
  if (const Json& uri = member(self, "uri"); uri.is_string())
    return resources_.find(uri.get_ref<const std::string&>());
  const std::uint64_t view = whole(self, "bufferView", kAbsent);
  if (view == kAbsent) return bad_input("is not in the file; export the file again");
  const auto bytes = buffer_.view(view);
  if (!bytes) return fail(bytes.error().code, "cannot be read: " + bytes.error().message);
  return bytes->bytes;
}

std::string GltfPictures::name(std::uint64_t index) const {
  const Json& self = element(document_, "images", index);
  const Json& uri = member(self, "uri");
  const bool is_file = uri.is_string() && !is_data_uri(uri.get_ref<const std::string&>());
  return text(self, "name",
              is_file ? percent_decoded(uri.get_ref<const std::string&>()) : std::string());
}

std::uint64_t GltfPictures::count() const {
  const Json& all = member(document_, "images");
  return all.is_array() ? all.size() : 0;
}

std::vector<std::string> GltfPictures::report() const {
  std::map<std::string, std::vector<std::uint64_t>> images;  // fault -> indices of images
  for (const auto& [index, fault] : faults_)
    images[fault].push_back(index);
  std::vector<std::string> lines;
  for (const auto& [fault, indices] : images) {
    std::string line = counted(indices.size(), "texture map");
    if (indices[0] != kAbsent)
      line +=
          (indices.size() > 1 ? ", first image " : ", image ") + std::to_string(indices[0]) + ',';
    line += " not carried: it " + fault;
    lines.push_back(std::move(line));
  }
  return lines;
}

}  // namespace vitrine::inline codec
