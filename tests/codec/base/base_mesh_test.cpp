// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>

#include "codec/base/base_decoder.h"
#include "codec/base/base_encoder.h"
#include "support/library_base.h"
#include "support/random_mesh.h"

namespace vitrine {
namespace {

BaseMesh random_base(std::uint64_t seed, std::uint32_t size = 120) {
  const LatticeMesh mesh = test::random_mesh(seed, size);
  return {.positions = mesh.positions,
          .faces = mesh.faces,
          .attributes = lattice_attributes(mesh.attributes)};
}

std::vector<Triangle> canonical(std::vector<Triangle> faces) {
  for (Triangle& f : faces)
    std::rotate(f.begin(), std::min_element(f.begin(), f.end()), f.end());
  std::sort(faces.begin(), faces.end());
  return faces;
}

TEST(BaseMesh, RandomMeshesComeBackVertexByVertex) {
  for (std::uint64_t seed = 0; seed < 1'000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const BaseMesh base = random_base(seed);
    const auto encoded = encode_base(base);
    ASSERT_TRUE(encoded) << encoded.error().message;
    ASSERT_EQ(encoded->original.size(), base.positions.size());
    for (std::size_t v = 0; v < base.positions.size(); ++v) {
      ASSERT_EQ(encoded->decoded.positions[v], base.positions[encoded->original[v]]);
      for (std::size_t i = 0; i < base.attributes.size(); ++i) {
        ASSERT_EQ(encoded->decoded.attributes[i].values[v],
                  base.attributes[i].values[encoded->original[v]]);
      }
    }
    std::vector<Triangle> faces = encoded->decoded.faces;
    for (Triangle& t : faces)
      t = {encoded->original[t[0]], encoded->original[t[1]], encoded->original[t[2]]};
    ASSERT_EQ(canonical(faces), canonical(base.faces));
  }
}

void expect_as_the_library(const BaseMesh& base) {
  const auto encoded = encode_base(base);
  ASSERT_TRUE(encoded) << encoded.error().message;
  const auto peer = test::library_base(encoded->bytes, semantics_of(base.attributes));
  ASSERT_TRUE(peer);
  ASSERT_EQ(encoded->decoded.positions, peer->positions);
  ASSERT_EQ(encoded->decoded.faces, peer->faces);
  ASSERT_EQ(encoded->decoded.attributes.size(), peer->attributes.size());
  for (std::size_t i = 0; i < peer->attributes.size(); ++i)
    ASSERT_EQ(encoded->decoded.attributes[i].values, peer->attributes[i].values);
}

TEST(BaseMesh, IsReadAsTheDracoLibraryReadsIt) {
  for (std::uint64_t seed = 0; seed < 1'000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    expect_as_the_library(random_base(seed));
  }
}

TEST(BaseMesh, LargeOnesAreReadAsTheDracoLibraryReadsThem) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    expect_as_the_library(random_base(seed, 5'000));
  }
}

Manifest manifest_of(const BaseMesh& base) {
  Manifest manifest;
  manifest.attributes = semantics_of(base.attributes);
  manifest.levels = {{.vertices = static_cast<std::uint32_t>(base.positions.size()),
                      .faces = static_cast<std::uint32_t>(base.faces.size())}};
  return manifest;
}

TEST(BaseMesh, DecodesToTheCountsOfTheHeaderOrNotAtAll) {
  const BaseMesh base = random_base(7);
  const auto encoded = encode_base(base);
  ASSERT_TRUE(encoded);
  Manifest manifest = manifest_of(base);
  const auto decoded = decode_base(encoded->bytes, manifest);
  ASSERT_TRUE(decoded) << decoded.error().message;
  EXPECT_EQ(decoded->positions, encoded->decoded.positions);
  EXPECT_EQ(decoded->faces, encoded->decoded.faces);
  ++manifest.levels[0].vertices;
  EXPECT_FALSE(decode_base(encoded->bytes, manifest));
  --manifest.levels[0].vertices;
  const PerSemantic<Semantic> none, colour = {Semantic::kColour};
  manifest.attributes = manifest.attributes.empty() ? colour : none;
  EXPECT_FALSE(decode_base(encoded->bytes, manifest));
}

TEST(BaseMesh, RefusesWhatIsNoEdgebreakerMesh) {
  Manifest manifest;
  manifest.levels = {{}};
  auto bytes = encode_base(random_base(7))->bytes;
  EXPECT_FALSE(decode_base({}, manifest));
  EXPECT_FALSE(decode_base(std::span(bytes).first(5), manifest));
  bytes[8] = 0;  // selects Draco's sequential method instead of edgebreaker
  EXPECT_FALSE(decode_base(bytes, manifest));
  bytes[8] = 1;
  bytes[7] = 0;  // states a point cloud instead of a mesh
  EXPECT_FALSE(decode_base(bytes, manifest));
}

TEST(BaseMesh, NoPrefixOfOneIsRead) {
  for (const std::uint64_t seed : {3, 7, 8}) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const BaseMesh base = random_base(seed);
    const Manifest manifest = manifest_of(base);
    const auto bytes = encode_base(base)->bytes;
    for (std::size_t length = 0; length < bytes.size(); ++length)
      ASSERT_FALSE(decode_base(std::span(bytes).first(length), manifest)) << length;
  }
}

TEST(BaseMesh, AnotherVariantOfEdgebreakerIsNotSupported) {
  const BaseMesh base = random_base(7);
  auto bytes = encode_base(base)->bytes;
  bytes[11] = 2;  // selects Draco's coding of symbols by the valences of vertices
  const auto decoded = decode_base(bytes, manifest_of(base));
  ASSERT_FALSE(decoded);
  EXPECT_EQ(decoded.error().code, ErrorCode::kUnsupported);
}

}  // namespace
}  // namespace vitrine
