// SPDX-License-Identifier: Apache-2.0
#include "codec/gltf/gltf_document.h"

#include <algorithm>
#include <array>
#include <set>

#include "codec/gltf/data_uri.h"
#include "codec/repair/raw_mesh.h"

namespace vitrine::inline codec {
namespace {

constexpr int kDeepestJson = 64;

struct JsonSize {
  std::uint64_t bytes = 0;  // size of the JSON without the contents of data: URIs
  int depth = 0;
};

// Returns the position of the quotation mark that ends the string. `begin` is the position of the
// string's first character.
std::size_t end_of_string(std::string_view json, std::size_t begin) {
  std::size_t at = begin;
  while (at < json.size() && json[at] != '"')
    at += json[at] == '\\' ? 2 : 1;
  return std::min(at, json.size());
}

JsonSize size_of(std::string_view json) {
  JsonSize size{.bytes = json.size()};
  int depth = 0;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (c == '[' || c == '{') size.depth = std::max(size.depth, ++depth);
    if (c == ']' || c == '}') --depth;
    if (c != '"') continue;
    const std::size_t begin = i + 1;
    i = end_of_string(json, begin);
    if (is_data_uri(json.substr(begin))) size.bytes -= i - begin;
  }
  return size;
}

// Whether the reader handles an extension. Unknown extensions for materials and textures are
// ignored and reported.
bool is_read(std::string_view extension) {
  return extension == "KHR_mesh_quantization" || extension == "KHR_draco_mesh_compression" ||
         extension == "EXT_meshopt_compression" || extension == "EXT_mesh_gpu_instancing" ||
         extension.starts_with("KHR_materials_") || extension.starts_with("KHR_texture_") ||
         extension.starts_with("EXT_texture_");
}

// Whether an extension changes or compresses the geometry. A file that requires such an extension
// cannot be read by a reader that ignores the extension. The words below occur in the names of all
// such extensions in the registry of glTF. Extensions for lights, metadata, visibility and the like
// contain none of them.
bool changes_geometry(std::string_view extension) {
  constexpr std::array<std::string_view, 13> kWords{
      "compress",  "quantiz",      "instancing", "voxel",    "splatting", "primitive_restart",
      "micromesh", "displacement", "micromap",   "accessor", "buffer",    "subdivision",
      "MPEG_mesh"};
  return std::ranges::any_of(
      kWords, [&](std::string_view word) { return extension.find(word) != extension.npos; });
}

// Returns the required extensions that are not read.
std::set<std::string> required_but_unread(const Json& document) {
  std::set<std::string> names;
  for (const Json& name : member(document, "extensionsRequired")) {
    if (name.is_string() && !is_read(name.get_ref<const std::string&>()))
      names.insert(name.get<std::string>());
  }
  return names;
}

Expected<void> check_extensions(const Json& document) {
  for (const std::string& extension : required_but_unread(document)) {
    if (!changes_geometry(extension)) continue;
    return fail(ErrorCode::kUnsupported, "the glTF needs the extension " + in_quotes(extension) +
                                             ", which is not read; export without it");
  }
  return {};
}

// Returns a version as text. Some exporters write it as a number.
std::string version_text(const Json& asset, std::string_view key) {
  const Json& version = member(asset, key);
  if (version.is_number() && version.get<double>() == 2) return "2.0";
  return version.is_string() ? version.get<std::string>() : version.dump();
}

// Applies glTF's version rules. If the document states minVersion, it must be 2.0. Otherwise
// `version` must be 2.x. If both are missing, the version of the container is enough.
Expected<void> check_version(const Json& document) {
  const Json& asset = member(document, "asset");
  const bool has_least = !member(asset, "minVersion").is_null();
  const std::string version = version_text(asset, has_least ? "minVersion" : "version");
  if (!has_least && member(asset, "version").is_null()) return {};
  if (has_least ? version == "2.0" : version.starts_with("2.")) return {};
  return fail(ErrorCode::kUnsupported,
              "glTF version " + in_quotes(version) + " is not read; export glTF 2.0");
}

}  // namespace

Unexpected bad_gltf(std::string what) {
  return bad_input("glTF: " + std::move(what) + "; the file is damaged, export it again");
}

Expected<Json> parse_gltf(std::string_view json, const Limits& limits) {
  const JsonSize size = size_of(json);
  if (size.bytes > limits.header_bytes) {
    return fail(ErrorCode::kLimit, "the glTF's JSON is " + counted(size.bytes, "byte") +
                                       " long, too much; export the mesh alone");
  }
  if (size.depth > kDeepestJson) return bad_gltf("the JSON is nested too deeply");
  Json document = Json::parse(json.begin(), json.end(), nullptr, false);
  if (!document.is_object()) return bad_gltf("the document is missing or not JSON");
  if (auto ok = check_version(document); !ok) return tl::unexpected(ok.error());
  if (auto ok = check_extensions(document); !ok) return tl::unexpected(ok.error());
  return document;
}

std::vector<std::string> report_extensions(const Json& document) {
  const std::set<std::string> names = required_but_unread(document);
  if (names.empty()) return {};
  return {counted(names.size(), "required extension") + " not read, such as " +
          in_quotes(*names.begin()) +
          "; compare the model with its source, or export the file without it"};
}

}  // namespace vitrine::inline codec
