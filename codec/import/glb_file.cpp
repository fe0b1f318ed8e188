// SPDX-License-Identifier: Apache-2.0
#include "codec/import/glb_file.h"

#include "codec/core/byte_cursor.h"
#include "codec/repair/raw_mesh.h"

namespace vitrine::inline codec {
namespace {

constexpr int kDeepestJson = 64;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;

Unexpected cut_short(std::string what) {
  return bad_input("GLB: " + std::move(what) + "; it is cut short, copy it again");
}

bool is_too_deep(std::string_view json) {
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (c == '"') in_string = !in_string;
    if (in_string && c == '\\') ++i;
    if (in_string) continue;
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    if (depth > kDeepestJson) return true;
  }
  return false;
}

Expected<std::size_t> checked_length(std::span<const std::uint8_t> bytes) {
  ByteReader cursor(bytes);
  cursor.skip(4);
  const auto version = cursor.read<std::uint32_t>();
  const auto length = cursor.read<std::uint32_t>();
  if (!cursor.is_ok()) return cut_short("the file ends within its header");
  if (version != 2) {
    return fail(ErrorCode::kUnsupported,
                "GLB version " + std::to_string(version) + " is not read; export glTF 2.0");
  }
  if (length > bytes.size()) {
    return cut_short("the header claims " + counted(length, "byte") + ", the file has " +
                     std::to_string(bytes.size()));
  }
  return length;
}

Expected<Json> parse(std::string_view json, const Limits& limits) {
  if (json.size() > limits.header_bytes) {
    return fail(ErrorCode::kLimit, "the GLB's JSON is " + counted(json.size(), "byte") +
                                       " long, too much; export the mesh alone");
  }
  if (is_too_deep(json)) return bad_glb("the JSON is nested too deeply");
  Json document = Json::parse(json.begin(), json.end(), nullptr, false);
  if (!document.is_object()) return bad_glb("the JSON chunk is missing or not JSON");
  return document;
}

// Whether a required extension can be handled. Materials and textures that are not supported are
// ignored and reported. All other extensions must be supported.
bool is_read(std::string_view extension) {
  return extension == "KHR_mesh_quantization" || extension == "KHR_draco_mesh_compression" ||
         extension == "EXT_meshopt_compression" || extension.starts_with("KHR_materials_") ||
         extension.starts_with("KHR_texture_") || extension.starts_with("EXT_texture_");
}

Expected<void> check_extensions(const Json& document) {
  for (const Json& name : member(document, "extensionsRequired")) {
    const std::string extension = name.is_string() ? name.get<std::string>() : std::string();
    if (is_read(extension)) continue;
    return fail(ErrorCode::kUnsupported, "the GLB needs the extension " + in_quotes(extension) +
                                             ", which is not read; export without it");
  }
  return {};
}

// Applies glTF's version rules. If the document states minVersion, that version must be fully
// supported. Otherwise the major version must be supported. If the document states neither, only
// the version of the container is checked.
Expected<void> check_version(const Json& document) {
  const Json& asset = member(document, "asset");
  const bool has_least = !member(asset, "minVersion").is_null();
  const std::string version = text(asset, has_least ? "minVersion" : "version", "");
  if (!has_least && member(asset, "version").is_null()) return {};
  if (has_least ? version == "2.0" : version.starts_with("2.")) return {};
  return fail(ErrorCode::kUnsupported,
              "glTF version " + in_quotes(version) + " is not read; export glTF 2.0");
}

}  // namespace

Unexpected bad_glb(std::string what) {
  return bad_input("GLB: " + std::move(what) + "; the file is damaged, export it again");
}

Expected<GlbFile> open_glb(std::span<const std::uint8_t> bytes, const Limits& limits) {
  const auto length = checked_length(bytes);
  if (!length) return tl::unexpected(length.error());
  GlbFile file;
  std::string_view json;
  for (std::size_t at = 12; at + 8 <= *length;) {
    const auto size = load<std::uint32_t>(&bytes[at]);
    const auto type = load<std::uint32_t>(&bytes[at + 4]);
    if (size > *length - at - 8) return bad_glb("a chunk is cut short");
    const auto chunk = bytes.subspan(at + 8, size);
    if (type == kJsonChunk && json.empty()) {
      json = {reinterpret_cast<const char*>(chunk.data()), size};
    }
    if (type == kBinaryChunk && file.binary.empty()) file.binary = chunk;
    at += 8 + std::size_t{size};
  }
  auto document = parse(json, limits);
  if (!document) return tl::unexpected(document.error());
  file.document = *std::move(document);
  if (auto ok = check_version(file.document); !ok) return tl::unexpected(ok.error());
  if (auto ok = check_extensions(file.document); !ok) return tl::unexpected(ok.error());
  return file;
}

}  // namespace vitrine::inline codec
