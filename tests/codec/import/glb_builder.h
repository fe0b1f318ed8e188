// SPDX-License-Identifier: Apache-2.0
// Builds a glTF file piece by piece.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "codec/import/reading.h"

namespace vitrine::testing {

// Returns a GLB file with this JSON document and this binary chunk.
inline std::string glb(std::string json, std::string binary) {
  while (json.size() % 4 != 0)
    json += ' ';
  while (binary.size() % 4 != 0)
    binary += '\0';
  const auto u32 = [](std::size_t n) {
    return bytes_of<std::uint32_t>({static_cast<std::uint32_t>(n)});
  };
  return "glTF" + u32(2) + u32(28 + json.size() + binary.size()) + u32(json.size()) + "JSON" +
         json + u32(binary.size()) + std::string("BIN\0", 4) + binary;
}

class GlbBuilder {
 public:
  using Json = nlohmann::json;

  Json document = {{"asset", {{"version", "2.0"}}}};

  // Adds a buffer view of `bytes` and returns its index. `more` holds further members of the view.
  std::size_t view(const std::string& bytes, Json more = Json::object()) {
    more.update(place(bytes));
    return append("bufferViews", std::move(more));
  }

  // Appends `bytes` to the binary chunk. Returns the buffer, offset and length as members of a
  // buffer view.
  Json place(const std::string& bytes) {
    binary_.resize((binary_.size() + 3) / 4 * 4);
    const std::size_t offset = binary_.size();
    binary_ += bytes;
    return {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes.size()}};
  }

  std::size_t accessor(const char* type, int component, std::size_t count,
                       Json more = Json::object()) {
    more.update({{"type", type}, {"componentType", component}, {"count", count}});
    return append("accessors", std::move(more));
  }

  std::size_t floats(const char* type, std::initializer_list<float> values, std::size_t count) {
    return accessor(type, 5126, count, {{"bufferView", view(bytes_of<float>(values))}});
  }

  // Appends `value` to the document's array `key` and returns its index there.
  std::size_t append(const char* key, Json value) {
    document[key].push_back(std::move(value));
    return document[key].size() - 1;
  }

  void mesh(Json primitive) { append("meshes", {{"primitives", Json::array({primitive})}}); }

  std::string file() const { return glb(document.dump(), binary_); }

  // Returns a glTF file as text. Its buffer has the URI `uri` and the contents of binary().
  std::string text_file(const std::string& uri) const {
    Json text = document;
    text["buffers"] = {{{"uri", uri}, {"byteLength", binary_.size()}}};
    return text.dump();
  }
  const std::string& binary() const { return binary_; }

 private:
  std::string binary_;
};

}  // namespace vitrine::testing
