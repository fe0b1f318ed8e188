// SPDX-License-Identifier: Apache-2.0
#include "codec/export/meshopt_streams.h"

#include <meshoptimizer.h>

#include <cstring>

namespace vitrine::inline codec {
namespace {

template <class T>
std::vector<T> moved(const std::vector<T>& old, const std::vector<unsigned>& remap) {
  std::vector<T> out(old.size());
  for (std::size_t v = 0; v < old.size(); ++v)
    out[remap[v]] = old[v];
  return out;
}

std::vector<unsigned> indices_of(const std::vector<Triangle>& faces) {
  std::vector<unsigned> indices;
  indices.reserve(faces.size() * 3);
  for (const Triangle& face : faces)
    indices.insert(indices.end(), face.begin(), face.end());
  return indices;
}

}  // namespace

void order_for_meshopt(SeamVertices& vertices) {
  const std::size_t count = vertices.original.size();
  std::vector<unsigned> indices = indices_of(vertices.faces);
  meshopt_optimizeVertexCache(indices.data(), indices.data(), indices.size(), count);
  std::vector<unsigned> remap(count);
  auto next = static_cast<unsigned>(
      meshopt_optimizeVertexFetchRemap(remap.data(), indices.data(), indices.size(), count));
  for (unsigned& to : remap) {
    if (to == ~0u) to = next++;  // vertices without faces come last
  }
  for (std::size_t i = 0; i < indices.size(); ++i)
    vertices.faces[i / 3][i % 3] = remap[indices[i]];
  vertices.original = moved(vertices.original, remap);
  for (auto& set : vertices.coordinates)
    set = moved(set, set.empty() ? std::vector<unsigned>() : remap);
}

void compress_attribute(GlbStream& stream) {
  if (stream.filter == "OCTAHEDRAL") {
    std::vector<float> normals(stream.count * 4);
    std::memcpy(normals.data(), stream.bytes.data(), stream.bytes.size());
    stream.stride = 4;
    stream.bytes.resize(stream.count * 4);
    meshopt_encodeFilterOct(stream.bytes.data(), stream.count, 4, 8, normals.data());
  }
  std::vector<std::uint8_t> out(meshopt_encodeVertexBufferBound(stream.count, stream.stride));
  out.resize(meshopt_encodeVertexBuffer(out.data(), out.size(), stream.bytes.data(), stream.count,
                                        stream.stride));
  stream.bytes = std::move(out);
  stream.mode = "ATTRIBUTES";
}

void compress_indices(GlbStream& stream, const SeamVertices& vertices) {
  const std::vector<unsigned> indices = indices_of(vertices.faces);
  std::vector<std::uint8_t> out(
      meshopt_encodeIndexBufferBound(indices.size(), vertices.original.size()));
  out.resize(meshopt_encodeIndexBuffer(out.data(), out.size(), indices.data(), indices.size()));
  stream.bytes = std::move(out);
  stream.mode = "TRIANGLES";
}

}  // namespace vitrine::inline codec
