// SPDX-License-Identifier: Apache-2.0
#include "codec/format/manifest.h"
#include "codec/format/cell.h"

#include <gtest/gtest.h>

#include "support/random_mesh.h"
#include "support/sealed.h"

namespace vitrine {
namespace {

using test::Dice;

Sha256 random_hash(Dice& dice) {
  Sha256 hash;
  for (std::uint8_t& byte : hash)
    byte = static_cast<std::uint8_t>(dice.below(256));
  return hash;
}

void add_levels(Dice& dice, Manifest& m) {
  LevelInfo level{.vertices = 3 + dice.below(300), .faces = 1 + dice.below(600)};
  for (std::uint32_t count = 1 + dice.below(12); count > 0; --count) {
    level.max_error = static_cast<float>(dice.below(1000)) / 7.0f;
    level.rms_error = static_cast<float>(dice.below(1000)) / 9.0f;
    level.display_filter = static_cast<float>(dice.below(11)) / 10.0f;
    m.levels.push_back(level);
    const std::uint32_t added = dice.below(100'000);
    level.vertices += added;
    level.faces += added + dice.below(added + 1);
  }
  if (m.levels.size() > 1) m.levels[0].shift = dice.below(kMaxShift + 1);
}

// Adds a node and all nodes below it to the region tree. The node may fork at `level` or at a finer
// level.
void add_node(Dice& dice, std::uint32_t level, Manifest& m) {
  const auto levels = static_cast<std::uint32_t>(m.levels.size());
  RegionNode node;
  if (level < levels && !dice.one_in(4)) node.fork = level + dice.below(levels - level);
  if (node.fork != 0) {
    node.plane = {static_cast<std::uint8_t>(dice.below(3)), dice.between(-70'000, 70'000)};
  }
  const Vec3i low = {dice.between(-70'000, 0), dice.between(-70'000, 0), dice.between(-9, 0)};
  node.box = {low, low + Vec3i{dice.between(0, 9), dice.between(0, 70'000), 0}};
  m.tree.nodes.push_back(node);
  if (node.fork == 0) return;
  add_node(dice, node.fork + dice.below(2), m);
  add_node(dice, node.fork + dice.below(2), m);
}

void add_regions(Dice& dice, Manifest& m) {
  m.tree.nodes.clear();
  add_node(dice, 2, m);
  ASSERT_TRUE(m.tree.link());
  const std::uint32_t leaves = m.tree.leaves();
  m.adjacency.assign(leaves, {});
  for (std::uint32_t a = 0; a < leaves; ++a) {
    for (std::uint32_t b = 0; b < leaves; ++b) {
      if (a != b && (a + b) % 3 == 0) m.adjacency[a].push_back(b);
    }
  }
}

void add_chunks(Dice& dice, Manifest& m) {
  for (std::uint32_t level = 1; level < m.levels.size(); ++level) {
    std::uint32_t left = m.levels[level].vertices - m.levels[level - 1].vertices;
    const std::vector<std::uint32_t> regions = m.tree.regions_at(level);
    for (const std::uint32_t node : regions) {
      const std::uint32_t own = node == regions.back() ? left : dice.below(left + 1);
      const std::uint32_t inserted = m.has_insertions ? dice.below(own + 1) : 0;
      left -= own;
      m.chunks.push_back({.level = level,
                          .region = m.tree.nodes[node].first,
                          .node = node,
                          .length = own / 16 + dice.below(50'000),
                          .splits = own - inserted,
                          .inserted = inserted,
                          .max_error = m.tree.leaves() == 1
                                           ? m.levels[level].max_error
                                           : static_cast<float>(dice.below(1000)) / 7.0f,
                          .sha256 = random_hash(dice)});
    }
  }
}

Manifest random_manifest(std::uint64_t seed) {
  Dice dice(seed);
  Manifest m;
  m.lattice = {.origin = {dice.between(-900, 900) / 7.0, 1e-9, -3e12},
               .step = (1 + dice.below(1000)) / 997.0,
               .bits = dice.between(10, 16)};
  m.unit = dice.one_in(2) ? "" : "mm";
  m.placement = dice.one_in(2) ? Placement::kPyramid : Placement::kMidpoint;
  if (dice.one_in(2)) m.attributes = {Semantic::kColour};
  m.has_insertions = dice.one_in(2);
  m.loops = dice.below(50);
  add_levels(dice, m);
  add_regions(dice, m);
  m.base_length = dice.below(100'000);
  m.base_sha256 = random_hash(dice);
  add_chunks(dice, m);
  return m;
}

void expect_equal(const Manifest& a, const Manifest& b) {
  EXPECT_EQ(a.lattice, b.lattice);
  EXPECT_EQ(a.unit, b.unit);
  EXPECT_EQ(a.placement, b.placement);
  EXPECT_EQ(a.attributes, b.attributes);
  EXPECT_EQ(a.has_insertions, b.has_insertions);
  EXPECT_EQ(a.loops, b.loops);
  EXPECT_EQ(a.adjacency, b.adjacency);
  EXPECT_EQ(a.base_offset, b.base_offset);
  EXPECT_EQ(a.base_sha256, b.base_sha256);
  EXPECT_EQ(a.file_bytes, b.file_bytes);
  ASSERT_EQ(a.levels.size(), b.levels.size());
  for (std::size_t i = 0; i < a.levels.size(); ++i) {
    EXPECT_EQ(a.levels[i].vertices, b.levels[i].vertices);
    EXPECT_EQ(a.levels[i].faces, b.levels[i].faces);
    EXPECT_EQ(a.levels[i].max_error, b.levels[i].max_error);
    EXPECT_EQ(a.levels[i].rms_error, b.levels[i].rms_error);
    EXPECT_EQ(a.levels[i].display_filter, b.levels[i].display_filter);
    EXPECT_EQ(a.levels[i].shift, b.levels[i].shift);
  }
  ASSERT_EQ(a.tree.nodes.size(), b.tree.nodes.size());
  for (std::size_t i = 0; i < a.tree.nodes.size(); ++i) {
    EXPECT_EQ(a.tree.nodes[i].fork, b.tree.nodes[i].fork);
    EXPECT_EQ(a.tree.nodes[i].box, b.tree.nodes[i].box);
    EXPECT_EQ(a.tree.nodes[i].plane.axis, b.tree.nodes[i].plane.axis);
    EXPECT_EQ(a.tree.nodes[i].plane.at, b.tree.nodes[i].plane.at);
  }
  ASSERT_EQ(a.chunks.size(), b.chunks.size());
  for (std::size_t i = 0; i < a.chunks.size(); ++i) {
    EXPECT_EQ(a.chunks[i].level, b.chunks[i].level);
    EXPECT_EQ(a.chunks[i].region, b.chunks[i].region);
    EXPECT_EQ(a.chunks[i].node, b.chunks[i].node);
    EXPECT_EQ(b.find_chunk(a.chunks[i].level, a.chunks[i].region), i);
    EXPECT_EQ(a.chunks[i].offset, b.chunks[i].offset);
    EXPECT_EQ(a.chunks[i].length, b.chunks[i].length);
    EXPECT_EQ(a.chunks[i].splits, b.chunks[i].splits);
    EXPECT_EQ(a.chunks[i].inserted, b.chunks[i].inserted);
    EXPECT_EQ(a.chunks[i].max_error, b.chunks[i].max_error);
    EXPECT_EQ(a.chunks[i].sha256, b.chunks[i].sha256);
  }
}

TEST(Manifest, RandomHeadersComeBack) {
  for (std::uint64_t seed = 0; seed < 2'000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Manifest manifest = random_manifest(seed);
    const auto bytes = write_header(manifest);
    const auto parsed = parse_header(bytes);
    ASSERT_TRUE(parsed) << parsed.error().message;
    expect_equal(manifest, *parsed);
    ASSERT_EQ(*header_bytes(std::span(bytes).first(kHeaderPrefix)), bytes.size());
    if (HasFailure()) return;
  }
}

TEST(Manifest, ABoundStaysABoundInSinglePrecision) {
  Manifest manifest = random_manifest(1);
  manifest.levels[0].max_error = 0.1000000001;
  ASSERT_FALSE(manifest.chunks.empty());
  manifest.chunks[0].max_error = 0.1000000001;
  const auto parsed = parse_header(write_header(manifest));
  ASSERT_TRUE(parsed);
  EXPECT_GE(parsed->levels[0].max_error, 0.1000000001);
  EXPECT_LT(parsed->levels[0].max_error, 0.10000001);
  EXPECT_GE(parsed->chunks[0].max_error, 0.1000000001);
}

TEST(Manifest, EveryByteOfAHeaderIsProtected) {
  Manifest manifest = random_manifest(5);
  auto bytes = write_header(manifest);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    for (const int flip : {0x01, 0x80, 0xFF}) {
      bytes[i] = static_cast<std::uint8_t>(bytes[i] ^ flip);
      EXPECT_FALSE(parse_header(bytes)) << "byte " << i;
      bytes[i] = static_cast<std::uint8_t>(bytes[i] ^ flip);
    }
  }
  EXPECT_TRUE(parse_header(bytes));
}

// Applies `change` to a valid manifest. Expects that the reader refuses the result, and returns the
// error message.
template <class Change>
std::string refusal(const Change& change) {
  Manifest m;
  m.levels = {
      {.vertices = 4, .faces = 4}, {.vertices = 6, .faces = 8}, {.vertices = 8, .faces = 12}};
  m.tree.nodes = {{.fork = 2, .plane = {0, 5}}, {}, {}};
  EXPECT_TRUE(m.tree.link());
  m.adjacency = {{1}, {0}};
  m.chunks = {{.level = 1, .splits = 2},
              {.level = 2, .region = 0, .node = 1, .splits = 1},
              {.level = 2, .region = 1, .node = 2, .splits = 1}};
  auto bytes = write_header(m);
  EXPECT_TRUE(parse_header(bytes)) << parse_header(bytes).error().message;
  change(m);
  bytes = write_header(m);
  const auto parsed = parse_header(bytes);
  return parsed ? "accepted" : parsed.error().message;
}

TEST(Manifest, RefusesWhatCannotBe) {
  using ::std::string;
  const auto contains = [](const string& text, const char* part) {
    EXPECT_NE(text.find(part), string::npos) << text;
  };
  contains(refusal([](Manifest& m) { m.tree.nodes[0].fork = 1; }), "impossible level");
  contains(refusal([](Manifest& m) { m.tree.nodes[0].fork = 65; }), "impossible level");
  contains(refusal([](Manifest& m) { m.levels[1].faces = 3; }), "faces of level 1");
  contains(refusal([](Manifest& m) { m.levels[1].faces = 9; }), "faces of level 1");
  contains(refusal([](Manifest& m) { m.levels[1].vertices = 3; }), "lose vertices");
  contains(refusal([](Manifest& m) { m.levels = {{}}, m.tree = {}, m.chunks = {}; }),
           "0 vertices and 0 faces");
  contains(refusal([](Manifest& m) { m.levels[0].vertices = 2; }), "2 vertices");
  contains(refusal([](Manifest& m) { m.levels[0].faces = 0; }), "0 faces");
  contains(refusal([](Manifest& m) { m.levels[0].display_filter = 1.5; }), "display filter");
  contains(refusal([](Manifest& m) { m.levels[0].shift = kMaxShift + 1; }), "lattice");
  contains(refusal([](Manifest& m) { m.levels[1].shift = 1; }), "lattice");
  contains(refusal([](Manifest& m) { m.chunks[1].splits = 2; }), "level 2");
  contains(refusal([](Manifest& m) { m.chunks[1].splits = 0; }), "do not make up");
  const auto with_insertions = [](std::uint32_t faces, std::uint32_t inserted) {
    return refusal([=](Manifest& m) {
      m.has_insertions = true;
      m.levels[2] = {.vertices = 11, .faces = faces};
      m.chunks[2].inserted = inserted;
    });
  };
  EXPECT_EQ(with_insertions(10, 3), "accepted");
  contains(with_insertions(9, 3), "faces of level 2");
  contains(with_insertions(19, 3), "faces of level 2");
  contains(with_insertions(10, 2), "do not make up");
  contains(with_insertions(10, 4), "chunk of level 2");
  contains(refusal([](Manifest& m) { m.adjacency = {{1}, {}}; }), "symmetric");
  contains(refusal([](Manifest& m) { m.adjacency = {{0}, {0}}; }), "adjacency");
  contains(refusal([](Manifest& m) { m.tree.nodes[0].plane.axis = 3; }), "plane");
  contains(refusal([](Manifest& m) { m.tree.nodes[1].box.low.y = 1; }), "box");
  contains(refusal([](Manifest& m) { m.chunks[1].max_error = -1; }), "level 2");
  contains(refusal([](Manifest& m) { m.unit = "m\n"; }), "ASCII");
  contains(refusal([](Manifest& m) { m.unit = "a unit with a long name"; }), "unit");
  contains(refusal([](Manifest& m) { m.lattice.bits = 17; }), "bits");
  contains(refusal([](Manifest& m) { m.lattice.step = 0; }), "transform");
  contains(refusal([](Manifest& m) { m.lattice.step = 1e30; }), "transform");
}

TEST(Manifest, RefusesATreeWhoseChildForksBeforeItsParent) {
  Manifest m = random_manifest(1);
  m.levels.assign(5, {.vertices = 4, .faces = 4});
  m.chunks.clear();
  m.tree.nodes = {{.fork = 3}, {.fork = 2}, {}, {}, {}};
  EXPECT_FALSE(m.tree.link());
  const auto parsed = parse_header(write_header(m));
  ASSERT_FALSE(parsed);
  EXPECT_NE(parsed.error().message.find("part of"), std::string::npos) << parsed.error().message;
}

// A reader's memory must stay in proportion to the bytes that it reads. An empty chunk must
// therefore not state a million splits.
TEST(Manifest, RefusesMoreVerticesThanAChunkOfItsLengthBrings) {
  const auto with = [](std::uint32_t splits, std::uint64_t length, std::uint32_t inserted = 0) {
    return refusal([=](Manifest& m) {
      const std::uint32_t added = splits + inserted;
      m.has_insertions = inserted > 0;
      m.levels[1] = {.vertices = 4 + added, .faces = 4 + added};
      m.levels[2] = {.vertices = 6 + added, .faces = 6 + added};
      m.chunks[0].splits = splits;
      m.chunks[0].inserted = inserted;
      m.chunks[0].length = length;
    });
  };
  EXPECT_EQ(with(256, 0), "accepted");
  EXPECT_NE(with(257, 0), "accepted");
  EXPECT_EQ(with(257, 1), "accepted");
  EXPECT_EQ(with(246, 0, 10), "accepted");
  EXPECT_NE(with(247, 0, 10), "accepted");
  EXPECT_NE(with(0, 0, 257), "accepted");
}

TEST(Manifest, NamesTheVersionAndTheFeaturesItDoesNotKnow) {
  Manifest manifest = random_manifest(3);
  auto bytes = write_header(manifest);
  bytes[8] = 2;
  EXPECT_EQ(parse_header(bytes).error().code, ErrorCode::kUnsupported);
  EXPECT_NE(parse_header(bytes).error().message.find("version 2"), std::string::npos);
  bytes[8] = 1;
  bytes[10] = 7;  // readers accept any minor version
  EXPECT_TRUE(parse_header(test::sealed(bytes)));
  // The flag 0x10 is reserved for an attribute table. The flag 0x40 has no meaning yet.
  for (const int bit : {0x10, 0x40}) {
    auto with_bit = bytes;
    with_bit[16] = static_cast<std::uint8_t>(with_bit[16] | bit);
    with_bit = test::sealed(with_bit);
    EXPECT_EQ(parse_header(with_bit).error().code, ErrorCode::kUnsupported);
    EXPECT_NE(parse_header(with_bit).error().message.find(std::to_string(bit)), std::string::npos);
  }
}

}  // namespace
}  // namespace vitrine
