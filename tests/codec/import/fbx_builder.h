// SPDX-License-Identifier: Apache-2.0
// Writes small binary FBX files (version 7.4) for tests.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <string>
#include <vector>

namespace vitrine::testing {

template <class Number>
std::string raw_bytes(Number number) {
  return {reinterpret_cast<const char*>(&number), sizeof(Number)};
}

// These functions return a value of an FBX record, preceded by the letter of its type.
inline std::string fbx_text(const std::string& text) {
  return 'S' + raw_bytes(static_cast<std::uint32_t>(text.size())) + text;
}
inline std::string fbx_id(std::int64_t id) {
  return 'L' + raw_bytes(id);
}
inline std::string fbx_whole(std::int32_t number) {
  return 'I' + raw_bytes(number);
}
inline std::string fbx_real(double number) {
  return 'D' + raw_bytes(number);
}

template <class Number>
std::string fbx_array(char type, const std::vector<Number>& numbers, bool is_compressed = false) {
  std::string data(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number));
  if (is_compressed) {
    uLongf size = compressBound(data.size());
    std::string packed(size, '\0');
    compress(reinterpret_cast<Bytef*>(packed.data()), &size,
             reinterpret_cast<const Bytef*>(data.data()), data.size());
    data = packed.substr(0, size);
  }
  return type + raw_bytes(static_cast<std::uint32_t>(numbers.size())) +
         raw_bytes<std::uint32_t>(is_compressed ? 1 : 0) +
         raw_bytes(static_cast<std::uint32_t>(data.size())) + data;
}

// A record with its values and the records within it.
struct FbxRecord {
  std::string name;
  std::vector<std::string> values = {};
  std::vector<FbxRecord> inner = {};

  // Returns the bytes of the record. They state where the record ends in the file, so they depend
  // on its offset `at`.
  std::string bytes(std::size_t at) const {
    constexpr std::size_t kHead = 13;
    std::string all;
    for (const std::string& value : values)
      all += value;
    const std::size_t values_size = all.size();
    const std::size_t begin = at + kHead + name.size();
    for (const FbxRecord& record : inner)
      all += record.bytes(begin + all.size());
    if (!inner.empty()) all.append(kHead, '\0');
    return raw_bytes(static_cast<std::uint32_t>(begin + all.size())) +
           raw_bytes(static_cast<std::uint32_t>(values.size())) +
           raw_bytes(static_cast<std::uint32_t>(values_size)) + static_cast<char>(name.size()) +
           name + all;
  }
};

inline FbxRecord fbx_property(const std::string& name, const std::string& type,
                              std::vector<std::string> values) {
  std::vector<std::string> all{fbx_text(name), fbx_text(type), fbx_text(""), fbx_text("")};
  all.insert(all.end(), values.begin(), values.end());
  return {"P", all};
}

inline FbxRecord fbx_link(std::int64_t child, std::int64_t parent) {
  return {"C", {fbx_text("OO"), fbx_id(child), fbx_id(parent)}};
}

// Returns a layer element, such as LayerElementUV. It assigns one of `values` to each corner.
inline FbxRecord fbx_layer(const std::string& kind, const std::string& data,
                           const std::vector<double>& values, const std::string& indices,
                           const std::vector<std::int32_t>& at) {
  return {kind,
          {fbx_whole(0)},
          {{"Version", {fbx_whole(101)}},
           {"Name", {fbx_text("")}},
           {"MappingInformationType", {fbx_text("ByPolygonVertex")}},
           {"ReferenceInformationType", {fbx_text("IndexToDirect")}},
           {data, {fbx_array('d', values)}},
           {indices, {fbx_array('i', at)}}}};
}

// A tetrahedron as FBX. Tests add records to the members, and then call file().
struct FbxFile {
  static constexpr std::int64_t kGeometry = 11, kModel = 12, kMaterial = 13, kTexture = 14,
                                kVideo = 15;

  std::vector<FbxRecord> settings = {}, layers = {}, objects = {}, links = {}, placement = {};
  bool is_compressed = false;

  std::string file() const {
    std::vector<FbxRecord> used_layers;
    for (const FbxRecord& layer : layers)
      used_layers.push_back(
          {"LayerElement", {}, {{"Type", {fbx_text(layer.name)}}, {"TypedIndex", {fbx_whole(0)}}}});
    FbxRecord geometry{
        "Geometry",
        {fbx_id(kGeometry), fbx_text(std::string("g\0\1Geometry", 11)), fbx_text("Mesh")},
        {{"Vertices",
          {fbx_array<double>('d', {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, is_compressed)}},
         {"PolygonVertexIndex",
          {fbx_array<std::int32_t>('i', {0, 2, -2, 0, 1, -4, 1, 2, -4, 2, 0, -4},
                                   is_compressed)}}}};
    geometry.inner.insert(geometry.inner.end(), layers.begin(), layers.end());
    if (!layers.empty()) geometry.inner.push_back({"Layer", {fbx_whole(0)}, used_layers});
    FbxRecord model{"Model",
                    {fbx_id(kModel), fbx_text(std::string("m\0\1Model", 8)), fbx_text("Mesh")},
                    {{"Version", {fbx_whole(232)}}, {"Properties70", {}, placement}}};
    std::vector<FbxRecord> all_objects{geometry, model},
        all_links{fbx_link(kModel, 0), fbx_link(kGeometry, kModel)};
    all_objects.insert(all_objects.end(), objects.begin(), objects.end());
    all_links.insert(all_links.end(), links.begin(), links.end());
    const std::vector<FbxRecord> records{
        {"FBXHeaderExtension", {}, {{"FBXVersion", {fbx_whole(7400)}}}},
        {"GlobalSettings", {}, {{"Version", {fbx_whole(1000)}}, {"Properties70", {}, settings}}},
        {"Objects", {}, all_objects},
        {"Connections", {}, all_links}};
    std::string out =
        std::string("Kaydara FBX Binary  \0\x1a\0", 23) + raw_bytes<std::uint32_t>(7400);
    for (const FbxRecord& record : records)
      out += record.bytes(out.size());
    return out + std::string(13, '\0');
  }
};

// Returns an FBX whose material shows the picture `path`. If `content` is not empty, the file also
// contains the picture's bytes.
inline FbxFile textured_fbx(const std::string& path, const std::string& content = {}) {
  FbxFile fbx;
  fbx.layers = {fbx_layer("LayerElementUV", "UV", {0.25, 0.5, 0.75, 0.5}, "UVIndex",
                          {0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 1})};
  fbx.layers.push_back({"LayerElementMaterial",
                        {fbx_whole(0)},
                        {{"MappingInformationType", {fbx_text("AllSame")}},
                         {"ReferenceInformationType", {fbx_text("IndexToDirect")}},
                         {"Materials", {fbx_array<std::int32_t>('i', {0})}}}});
  fbx.objects = {
      {"Material",
       {fbx_id(FbxFile::kMaterial), fbx_text(std::string("paint\0\1Material", 15)), fbx_text("")},
       {{"ShadingModel", {fbx_text("phong")}}, {"Properties70", {}, {}}}},
      {"Texture",
       {fbx_id(FbxFile::kTexture), fbx_text(std::string("t\0\1Texture", 10)), fbx_text("")},
       {{"FileName", {fbx_text(path)}}, {"RelativeFilename", {fbx_text(path)}}}}};
  fbx.links = {fbx_link(FbxFile::kMaterial, FbxFile::kModel),
               {"C",
                {fbx_text("OP"), fbx_id(FbxFile::kTexture), fbx_id(FbxFile::kMaterial),
                 fbx_text("DiffuseColor")}}};
  if (content.empty()) return fbx;
  const std::string raw = 'R' + raw_bytes(static_cast<std::uint32_t>(content.size())) + content;
  fbx.objects.push_back(
      {"Video",
       {fbx_id(FbxFile::kVideo), fbx_text(std::string("v\0\1Video", 8)), fbx_text("Clip")},
       {{"FileName", {fbx_text(path)}},
        {"RelativeFilename", {fbx_text(path)}},
        {"Content", {raw}}}});
  fbx.links.push_back(fbx_link(FbxFile::kVideo, FbxFile::kTexture));
  return fbx;
}

}  // namespace vitrine::testing
