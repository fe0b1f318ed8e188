// SPDX-License-Identifier: Apache-2.0
// Tests GLB files with EXT_meshopt_compression. meshoptimizer encodes the buffers.
#include <meshoptimizer.h>

#include "codec/import/glb_builder.h"

namespace vitrine {
namespace {

using ::testing::HasSubstr;
using vitrine::testing::bytes_of;
using vitrine::testing::GlbBuilder;
using vitrine::testing::grid;
using vitrine::testing::read_text;
using vitrine::testing::refusal;
using Json = nlohmann::json;

std::string text(const std::vector<std::uint8_t>& bytes, std::size_t size) {
  return {bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)};
}

template <class T>
std::string coded_vertices(const std::vector<T>& values, std::size_t stride) {
  const std::size_t count = values.size() * sizeof(T) / stride;
  std::vector<std::uint8_t> out(meshopt_encodeVertexBufferBound(count, stride));
  return text(out,
              meshopt_encodeVertexBuffer(out.data(), out.size(), values.data(), count, stride));
}

std::string coded_triangles(const std::vector<std::uint32_t>& indices, std::size_t vertices) {
  std::vector<std::uint8_t> out(meshopt_encodeIndexBufferBound(indices.size(), vertices));
  return text(out,
              meshopt_encodeIndexBuffer(out.data(), out.size(), indices.data(), indices.size()));
}

std::string coded_sequence(const std::vector<std::uint32_t>& indices, std::size_t vertices) {
  std::vector<std::uint8_t> out(meshopt_encodeIndexSequenceBound(indices.size(), vertices));
  return text(out,
              meshopt_encodeIndexSequence(out.data(), out.size(), indices.data(), indices.size()));
}

std::vector<std::uint32_t> indices_of(const TriangleMesh& mesh) {
  std::vector<std::uint32_t> indices;
  for (const Triangle& face : mesh.faces)
    indices.insert(indices.end(), face.begin(), face.end());
  return indices;
}

// Adds a compressed buffer view as gltfpack writes it, whose fallback buffer has no bytes. Returns
// the index of the view.
std::size_t compressed_view(GlbBuilder& builder, const std::string& bytes, const char* mode,
                            std::size_t count, std::size_t stride, const char* filter = "NONE") {
  Json compression = builder.place(bytes);
  compression.update(
      {{"mode", mode}, {"count", count}, {"byteStride", stride}, {"filter", filter}});
  return builder.append("bufferViews",
                        {{"buffer", 1},
                         {"byteLength", count * stride},
                         {"extensions", {{"EXT_meshopt_compression", compression}}}});
}

// Returns a GLB of grid(n). Its positions are 16-bit integers, as KHR_mesh_quantization allows.
GlbBuilder compressed_grid(std::uint32_t n, const char* index_mode = "TRIANGLES") {
  const TriangleMesh mesh = grid(n);
  std::vector<std::uint16_t> positions;
  for (const Vec3& p : mesh.positions) {
    positions.insert(positions.end(),
                     {static_cast<std::uint16_t>(p.x), static_cast<std::uint16_t>(p.y), 0, 0});
  }
  const auto indices = indices_of(mesh);
  GlbBuilder builder;
  builder.document["extensionsRequired"] = {"EXT_meshopt_compression", "KHR_mesh_quantization"};
  const std::size_t vertices = mesh.positions.size();
  const std::size_t points = builder.accessor(
      "VEC3", 5123, vertices,
      {{"bufferView",
        compressed_view(builder, coded_vertices(positions, 8), "ATTRIBUTES", vertices, 8)}});
  const std::string coded = index_mode == std::string("TRIANGLES")
                                ? coded_triangles(indices, vertices)
                                : coded_sequence(indices, vertices);
  const std::size_t corners = builder.accessor(
      "SCALAR", 5125, indices.size(),
      {{"bufferView", compressed_view(builder, coded, index_mode, indices.size(), 4)}});
  builder.mesh({{"attributes", {{"POSITION", points}}}, {"indices", corners}});
  return builder;
}

// Rotates each face to start at its smallest vertex. The index codec may rotate faces, so tests
// compare faces in this form.
std::vector<Triangle> turned(std::vector<Triangle> faces) {
  for (Triangle& face : faces)
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
  return faces;
}

TEST(ReadMeshoptGlb, ReadsPositionsAndTriangles) {
  const auto result = read_text(compressed_grid(20).file());
  EXPECT_EQ(result.mesh.positions, grid(20).positions);
  EXPECT_EQ(turned(result.mesh.faces), turned(grid(20).faces));
}

TEST(ReadMeshoptGlb, ReadsIndexSequences) {
  EXPECT_EQ(read_text(compressed_grid(5, "INDICES").file()).mesh.faces, grid(5).faces);
}

TEST(ReadMeshoptGlb, ReadsFloatsWithTheExponentialFilter) {
  std::vector<std::uint32_t> values(12);
  const std::vector<float> corners = {0, 0, 0, 0, 1.5f, 0, 0, 0, 0, -2.25f, 0, 0};
  meshopt_encodeFilterExp(values.data(), 3, 16, 24, corners.data());
  GlbBuilder builder;
  const std::size_t points = builder.accessor(
      "VEC3", 5126, 3,
      {{"bufferView",
        compressed_view(builder, coded_vertices(values, 16), "ATTRIBUTES", 3, 16, "EXPONENTIAL")}});
  builder.mesh({{"attributes", {{"POSITION", points}}}});
  const auto result = read_text(builder.file());
  EXPECT_EQ(result.mesh.positions, (std::vector<Vec3>{{0, 0, 0}, {1.5, 0, 0}, {0, -2.25, 0}}));
}

TEST(ReadMeshoptGlb, RefusesWhatTheDecoderDoesNotTakeAndNamesTheView) {
  for (const auto& [key, value] : {std::pair<const char*, Json>{"count", 1'000'000'000'000},
                                   {"count", 0},
                                   {"byteStride", 6},
                                   {"byteStride", 1 << 30},
                                   {"byteLength", 20},
                                   {"mode", "TRIANGLES"}}) {
    GlbBuilder builder = compressed_grid(20);
    builder.document["bufferViews"][0]["extensions"]["EXT_meshopt_compression"][key] = value;
    EXPECT_THAT(refusal(builder.file()),
                HasSubstr("buffer view 0 is not valid meshopt-compressed data"))
        << key << ' ' << value;
  }
}

TEST(ReadMeshoptGlb, RefusesUnknownModesAndPlacesByName) {
  const auto refused = [](const char* key, const Json& value) {
    GlbBuilder builder = compressed_grid(3);
    builder.document["bufferViews"][0]["extensions"]["EXT_meshopt_compression"][key] = value;
    return refusal(builder.file());
  };
  EXPECT_THAT(refused("mode", "STRIPS"), HasSubstr("unknown meshopt mode 'STRIPS'"));
  EXPECT_THAT(refused("filter", "SINE"), HasSubstr("unknown meshopt filter 'SINE'"));
  EXPECT_THAT(refused("byteOffset", 1 << 30), HasSubstr("beyond the end"));
}

}  // namespace
}  // namespace vitrine
