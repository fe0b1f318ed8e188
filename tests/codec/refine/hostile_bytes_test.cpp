// SPDX-License-Identifier: Apache-2.0
// Decodes small files that are truncated after each byte, or in which a byte is changed. The
// header's hash is corrected, and no other hash is checked, so that the decoder sees the damage.
// The result must be an error or a valid mesh. The memory used must stay within a multiple of the
// file's size.
#include <gtest/gtest.h>

#include <array>
#include <new>
#include <tuple>

#include "codec/base/base_decoder.h"
#include "codec/refine/refiner.h"
#include "support/counting_new.h"
#include "support/heap_bound.h"
#include "support/meshes.h"
#include "support/random_mesh.h"
#include "support/sealed.h"
#include "support/seeds.h"
#include "support/stored_model.h"

namespace vitrine {
namespace {

using test::StoredModel;
using Bytes = std::span<const std::uint8_t>;

// Number of different changes tried per byte. Adjacent bytes start with different changes, so one
// change per byte is enough in slow builds with sanitizers.
#ifdef VITRINE_SANITISED
constexpr std::size_t kFlipsPerByte = 1;
#else
constexpr std::size_t kFlipsPerByte = 7;
#endif

LatticeMesh small_mesh(bool coloured) {
  LatticeMesh mesh = test::random_mesh(4, 200);
  mesh.attributes.colours.assign(coloured ? mesh.positions.size() : 0, Colour{200, 90, 17});
  for (std::size_t v = 0; v < mesh.attributes.colours.size(); ++v)
    mesh.attributes.colours[v][v % 3] = static_cast<std::uint8_t>(v);
  test::add_specks(mesh, 8, 1);
  return mesh;
}

StoredModel small_model(Placement placement, std::uint32_t region_vertices, bool coloured) {
  return test::store_model(
      small_mesh(coloured),
      {.placement = placement, .target_vertices = 12, .region_vertices = region_vertices});
}

Bytes part(Bytes bytes, std::uint64_t offset, std::uint64_t length) {
  const std::uint64_t from = std::min<std::uint64_t>(offset, bytes.size());
  return bytes.subspan(from, std::min<std::uint64_t>(length, bytes.size() - from));
}

bool is_manifold(const Refiner& refiner) {
  const LatticeMesh mesh = refiner.lattice_mesh();
  return mesh.faces.size() == refiner.face_count() &&
         Connectivity::close(refiner.vertex_count(), mesh.faces).has_value();
}

// Decodes as many chunks as possible. Returns whether the mesh was valid after each chunk.
bool survives(Bytes bytes) {
  auto manifest = parse_header(bytes);
  if (!manifest) return true;
  const auto base =
      decode_base(part(bytes, manifest->base_offset, manifest->base_length), *manifest);
  if (!base) return true;
  auto refiner = Refiner::start(std::move(*manifest), *base);
  if (!refiner) return true;
  for (std::size_t i = 0; i < refiner->manifest().chunks.size(); ++i) {
    const ChunkInfo& chunk = refiner->manifest().chunks[i];
    if (!refiner->apply(i, part(bytes, chunk.offset, chunk.length))) return true;
    if (!is_manifold(*refiner)) return false;
  }
  if (refiner->display_mesh().faces.size() != refiner->face_count()) return false;
  refiner->undo_to_faces(refiner->face_count() - 1);
  return is_manifold(*refiner);
}

class HostileBytes : public ::testing::TestWithParam<Placement> {
 protected:
  void expect_survival(Bytes bytes, std::size_t at) {
    test::start_peak();
    const std::size_t before = test::heap_bytes();
    ASSERT_TRUE(survives(bytes)) << "at byte " << at;
    ASSERT_LE(test::peak_heap_bytes() - before, test::kDecodingHeap.of(bytes.size()))
        << "at byte " << at;
  }

  const StoredModel model_ = GetParam() == Placement::kMidpoint
                                 ? small_model(Placement::kMidpoint, 0, true)
                                 : small_model(Placement::kPyramid, 80, false);
};

TEST_P(HostileBytes, TheFileItselfIsWhole) {
  EXPECT_EQ(model_.manifest.tree.leaves() > 1, GetParam() == Placement::kPyramid);
  EXPECT_GT(model_.manifest.chunks.size(), 3u);
  EXPECT_TRUE(model_.manifest.has_insertions);
  EXPECT_TRUE(survives(model_.file));
}

TEST_P(HostileBytes, CutAtEveryByte) {
  for (std::size_t n = 0; n < model_.file.size(); ++n) {
    const std::vector<std::uint8_t> cut(model_.file.begin(),
                                        model_.file.begin() + static_cast<std::ptrdiff_t>(n));
    ASSERT_NO_FATAL_FAILURE(expect_survival(cut, n));
  }
}

TEST_P(HostileBytes, EveryByteChanged) {
  auto bytes = model_.file;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const std::uint8_t was = bytes[i];
    const std::array<int, 7> flips{0x01, 0x04, 0x10, 0x80, 0xFF, 0x55, was};
    for (std::size_t n = 0; n < kFlipsPerByte; ++n) {
      bytes[i] = static_cast<std::uint8_t>(was ^ flips[(i + n) % flips.size()]);
      ASSERT_NO_FATAL_FAILURE(expect_survival(test::sealed(bytes), i));
    }
    bytes[i] = was;
  }
}

TEST_P(HostileBytes, ChunksOfNoise) {
  auto bytes = model_.file;
  for (std::uint64_t seed = 0; seed < test::seeds(300); ++seed) {
    test::Dice dice(seed);
    const std::uint32_t ones = dice.below(9);
    for (std::size_t i = model_.manifest.head_bytes(); i < bytes.size(); ++i)
      bytes[i] = dice.below(8) < ones ? 0 : static_cast<std::uint8_t>(dice.below(256));
    ASSERT_NO_FATAL_FAILURE(expect_survival(bytes, seed));
  }
}

INSTANTIATE_TEST_SUITE_P(Placements, HostileBytes,
                         ::testing::Values(Placement::kMidpoint, Placement::kPyramid));

// Builds with sanitizers omit these tests. Large models take minutes there, and memory use is the
// same.
#ifndef VITRINE_SANITISED
// The bounds are those that refiner.h states.
TEST(RefinerMemory, StaysWithinItsBytesPerTriangle) {
  for (const bool coloured : {false, true}) {
    const std::size_t bytes = coloured ? 64 : 60;
    const TriangleMesh torus = test::torus(300, 200);
    LatticeMesh mesh = quantise(torus, fit_lattice(torus.positions, 12));
    mesh.attributes.colours.assign(coloured ? mesh.positions.size() : 0, Colour{9, 8, 7});
    test::add_specks(mesh, 10'000, 1);
    const StoredModel model = test::store_model(mesh, {.region_vertices = coloured ? 4000u : 0u});
    Manifest manifest = model.manifest;
    test::start_peak();
    const std::size_t before = test::heap_bytes();
    auto refiner = Refiner::start(std::move(manifest), model.base);
    ASSERT_TRUE(refiner);
    for (std::size_t i = 0; i < model.manifest.chunks.size(); ++i)
      test::apply_chunk(*refiner, model, i);
    EXPECT_LE(test::peak_heap_bytes() - before,
              bytes * refiner->connectivity().face_count() + (512u << 10));
  }
}

// A split adds one vertex and six corners. Each vertex has an element in four arrays, and each
// corner has an element in two arrays.
constexpr std::size_t kArrayElementsPerSplit = 4 + 2 * 6;

TEST(RefinerMemory, IsAskedForByTheBlockAndNotByTheSplit) {
  const TriangleMesh torus = test::torus(300, 200);
  const StoredModel model =
      test::store_model(quantise(torus, fit_lattice(torus.positions, 12)), {});
  Refiner refiner = test::start_refiner(model);
  for (std::size_t i = 0; i < model.manifest.chunks.size(); ++i) {
    const std::size_t before = test::allocations(), splits = model.manifest.chunks[i].splits;
    test::apply_chunk(refiner, model, i);
    EXPECT_LE(test::allocations() - before,
              24 + splits * kArrayElementsPerSplit / Segments<Vec3i>::kBlock)
        << splits << " splits";
  }
  EXPECT_GT(model.manifest.chunks.back().splits, 10'000u);
}
#endif

const std::vector<std::uint8_t> unsplit(16, 0xFF);  // a chunk in which no vertex splits

void add_forks(std::uint32_t leaves, RegionTree& tree) {
  tree.nodes.push_back({.fork = leaves > 1 ? 2u : 0u});
  if (leaves == 1) return;
  add_forks(leaves / 2, tree);
  add_forks(leaves - leaves / 2, tree);
}

// Returns the manifest of a tetrahedron that is never refined, with `leaves` regions. If
// `neighbours` is true, all regions are adjacent to each other; otherwise none are.
Manifest crowded_header(std::uint32_t leaves, std::size_t levels, bool neighbours) {
  Manifest m;
  m.levels.assign(levels, {.vertices = 4, .faces = 4});
  m.tree.nodes.clear();
  add_forks(leaves, m.tree);
  EXPECT_TRUE(m.tree.link());
  m.adjacency.assign(leaves, {});
  for (std::uint32_t a = 0; neighbours && a < leaves; ++a) {
    for (std::uint32_t b = 0; b < leaves; ++b)
      if (a != b) m.adjacency[a].push_back(b);
  }
  for (std::uint32_t level = 1; level < levels; ++level) {
    for (const std::uint32_t node : m.tree.regions_at(level))
      m.chunks.push_back({.level = level, .region = m.tree.nodes[node].first, .node = node});
  }
  m.chunks[0].length = unsplit.size();
  return m;
}

// A header can state far more regions, adjacencies and chunks than the mesh has vertices.
TEST(RefinerMemory, FollowsTheBytesOfAHostileHeader) {
  const BaseMesh base{.positions = {{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {0, 0, 9}},
                      .faces = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  for (const auto& [leaves, levels, neighbours] :
       {std::tuple(2'500u, 3u, true), std::tuple(2'500u, 64u, false),
        std::tuple(60'000u, 3u, false)}) {
    Manifest crowded = crowded_header(leaves, levels, neighbours);
    const auto bytes = write_header(crowded);
    test::start_peak();
    const std::size_t before = test::heap_bytes();
    auto parsed = parse_header(bytes);
    ASSERT_TRUE(parsed) << parsed.error().message;
    auto refiner = Refiner::start(std::move(*parsed), base);
    ASSERT_TRUE(refiner) << refiner.error().message;
    ASSERT_TRUE(refiner->apply(0, unsplit));
    ASSERT_TRUE(refiner->apply(leaves, {}));
    EXPECT_LE(test::peak_heap_bytes() - before,
              60 * 4 + (std::size_t{leaves} << 10) + 8 * bytes.size() + (512u << 10))
        << leaves << " regions, " << levels << " levels";
  }
}

// Decodes the model and lets allocation number `allocation` fail. Returns false if that failure
// ended the decoding.
bool decodes_with_failure_at(std::size_t allocation, const StoredModel& model) {
  test::fail_allocation(allocation);
  try {
    auto manifest = parse_header(model.file);
    auto refiner = Refiner::start(std::move(manifest.value()), model.base);
    for (std::size_t i = 0; i < model.manifest.chunks.size(); ++i)
      test::apply_chunk(*refiner, model, i);
  } catch (const std::bad_alloc&) {
    return false;
  }
  test::fail_allocation(0);
  return true;
}

TEST(RefinerMemory, WhereItRunsOutItIsAnExceptionAndNothingIsLost) {
  const StoredModel model = small_model(Placement::kPyramid, 80, true);
  const std::size_t before = test::heap_bytes();
  std::size_t allocation = 1;
  while (!decodes_with_failure_at(allocation, model)) {
    ASSERT_EQ(test::heap_bytes(), before) << "at allocation " << allocation;
    ++allocation;
  }
  EXPECT_GT(allocation, model.manifest.chunks.size());
}

// A header of a few hundred bytes states the largest number of vertices that a reader allows.
TEST(HostileHeader, StatesAHundredMillionVerticesAndGetsNoMemory) {
  const StoredModel model = small_model(Placement::kMidpoint, 0, false);
  Manifest m = model.manifest;
  m.levels.resize(2);
  m.levels[1].shift = 0;
  m.levels[1].vertices = 100'000'000;
  m.levels[1].faces = 150'000'000;
  m.chunks.resize(1);
  m.chunks[0].inserted = 0;
  m.chunks[0].splits = m.levels[1].vertices - m.levels[0].vertices;
  m.chunks[0].length = 1ull << 30;
  const auto bytes = write_header(m);
  test::start_peak();
  const std::size_t before = test::heap_bytes();
  const auto parsed = parse_header(bytes);
  ASSERT_TRUE(parsed) << parsed.error().message;
  auto refiner = Refiner::start(*parsed, model.base);
  ASSERT_TRUE(refiner) << refiner.error().message;
  EXPECT_FALSE(refiner->apply(0, std::vector<std::uint8_t>(50)));
  EXPECT_LT(test::peak_heap_bytes() - before, test::kDecodingHeap.always);
}

}  // namespace
}  // namespace vitrine
