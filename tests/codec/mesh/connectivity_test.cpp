// SPDX-License-Identifier: Apache-2.0
#include "codec/mesh/connectivity.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "support/meshes.h"
#include "support/validate.h"

namespace vitrine::test {
namespace {

using ::testing::HasSubstr;

Connectivity close(const TriangleMesh& mesh) {
  auto closed = Connectivity::close(static_cast<std::uint32_t>(mesh.positions.size()), mesh.faces);
  EXPECT_TRUE(closed.has_value());
  return std::move(*closed);
}

void expect_refused(std::uint32_t vertices, const std::vector<Triangle>& faces,
                    const char* reason) {
  const auto closed = Connectivity::close(vertices, faces);
  ASSERT_FALSE(closed.has_value());
  EXPECT_EQ(closed.error().code, ErrorCode::kBadInput);
  EXPECT_THAT(closed.error().message, HasSubstr(reason));
}

TEST(Connectivity, AClosedSurfaceNeedsNoVirtualVertex) {
  const Connectivity mesh = close(torus(8, 6));
  expect_valid(mesh);
  EXPECT_EQ(mesh.loop_count(), 0u);
  EXPECT_EQ(mesh.face_count(), 96u);
}

TEST(Connectivity, EachBoundaryLoopGetsOneVirtualVertex) {
  const Connectivity mesh = close(tube(7, 4));
  expect_valid(mesh);
  ASSERT_EQ(mesh.loop_count(), 2u);
  EXPECT_EQ(mesh.loop_length(kVirtualBit), 7u);
  EXPECT_EQ(mesh.loop_length(kVirtualBit + 1), 7u);
}

TEST(Connectivity, LoopsAreNumberedByTheirSmallestVertex) {
  const Connectivity mesh = close(tube(7, 4));  // vertex 0 is on the first rim, 21 on the last
  const auto loop_at = [&](VertexId v) {
    std::array<Corner, 16> ring;
    for (std::uint32_t i = 0, n = mesh.ring(v, ring); i < n; ++i) {
      const VertexId w = mesh.vertex(next(ring[i]));
      if (is_virtual(w)) return w;
    }
    return kNoCorner;
  };
  EXPECT_EQ(loop_at(0), kVirtualBit);
  EXPECT_EQ(loop_at(21), kVirtualBit + 1);
  EXPECT_EQ(loop_at(10), kNoCorner);
}

TEST(Connectivity, RefusesWhatIsNotAManifoldAndNamesTheFace) {
  expect_refused(3, {{0, 1, 3}}, "out of range at face 0");
  expect_refused(3, {{0, 1, 2}, {1, 1, 2}}, "repeated vertex at face 1");
  expect_refused(5, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}, "at face 2");
  expect_refused(4, {{0, 1, 2}, {0, 1, 3}}, "at face 1");
  expect_refused(5, {{0, 1, 2}, {0, 3, 4}}, "more than one fan");
  expect_refused(4, {{0, 1, 2}}, "belongs to no face");
}

TEST(Connectivity, RefusesTwoClosedFansAtOneVertex) {
  std::vector<Triangle> faces = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
  for (const Triangle& f : std::vector(faces)) {
    const auto other = [](std::uint32_t v) { return v == 0 ? 0 : v + 3; };
    faces.push_back({other(f[0]), other(f[1]), other(f[2])});
  }
  expect_refused(7, faces, "more than one fan");
}

TEST(Connectivity, ARingThatDoesNotFitIsReportedAsZero) {
  const Connectivity mesh = close(torus(8, 6));
  std::array<Corner, 5> small;
  EXPECT_EQ(mesh.ring(0, small), 0u);
}

// Splits random vertices in random ways. The mesh must stay valid after each split. Undoing all
// splits must restore the initial mesh.
void expect_splits_undo(Connectivity mesh, unsigned seed) {
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  const auto before = canonical(live_faces(mesh));
  std::vector<VertexId> history;
  std::array<Corner, 64> ring;
  while (history.size() < 60) {
    const VertexId v = static_cast<VertexId>(random() % mesh.vertex_count());
    const std::uint32_t n = mesh.ring(v, ring);
    if (n == 0) continue;
    const std::uint32_t i = static_cast<std::uint32_t>(random() % n);
    const std::uint32_t j = (i + 1 + static_cast<std::uint32_t>(random() % (n - 1))) % n;
    const VertexId qi = mesh.vertex(next(ring[i])), qj = mesh.vertex(next(ring[j]));
    const VertexId w = mesh.split(v, {ring.data(), n}, i, j);
    ASSERT_EQ(w, mesh.vertex_count() - 1);
    const Corner last = 3 * mesh.face_count() - 6;
    ASSERT_EQ(mesh.vertex(last + 1), qi);
    ASSERT_EQ(mesh.vertex(last + 5), qj);
    ASSERT_NO_FATAL_FAILURE(expect_valid(mesh));
    history.push_back(v);
  }
  for (; !history.empty(); history.pop_back()) {
    mesh.unsplit(history.back());
    ASSERT_NO_FATAL_FAILURE(expect_valid(mesh));
  }
  EXPECT_EQ(canonical(live_faces(mesh)), before);
}

TEST(Connectivity, UnsplitTakesBackAnySequenceOfSplits) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    expect_splits_undo(close(torus(5, 4)), seed);
    expect_splits_undo(close(sheet(4, 4)), seed);
    expect_splits_undo(close(tube(5, 3)), seed);
  }
}

TEST(Connectivity, CollapseIsTheInverseOfSplit) {
  Connectivity mesh = close(torus(6, 5));
  const auto before = canonical(live_faces(mesh));
  std::array<Corner, 64> ring;
  for (VertexId v = 0; v < 30; ++v) {
    const std::uint32_t n = mesh.ring(v, ring);
    mesh.split(v, {ring.data(), n}, 1, 4);
    mesh.collapse(3 * mesh.face_count() - 3);  // the corner at v of the face added last
    expect_valid(mesh);
    EXPECT_EQ(canonical(live_faces(mesh)), before);
  }
}

TEST(Connectivity, SplitIsTheInverseOfCollapse) {
  const Connectivity fine = close(sheet(6, 5));
  for (VertexId v1 = 0; v1 < 30; ++v1) {
    Connectivity mesh = close(sheet(6, 5));
    std::array<Corner, 64> ring;
    mesh.ring(v1, ring);
    const Corner c = ring[0];
    const VertexId v2 = mesh.vertex(next(c)), apex12 = mesh.vertex(prev(c));
    const VertexId apex21 = mesh.vertex(mesh.opposite(prev(c)));
    if (is_virtual(v2) || v1 == 0 || v2 == 0 || v1 == 29 || v2 == 29) continue;
    mesh.collapse(c);
    const std::uint32_t n = mesh.ring(v1, ring);
    std::uint32_t i = n, j = n;
    for (std::uint32_t k = 0; k < n; ++k) {
      if (mesh.vertex(next(ring[k])) == apex21) i = k;
      if (mesh.vertex(next(ring[k])) == apex12) j = k;
    }
    ASSERT_LT(i, n);
    ASSERT_LT(j, n);
    const VertexId w = mesh.split(v1, {ring.data(), n}, i, j);
    std::vector<Triangle> faces = live_faces(mesh);
    for (Triangle& f : faces)
      std::replace(f.begin(), f.end(), w, v2);
    EXPECT_EQ(canonical(faces), canonical(live_faces(fine)));
  }
}

TEST(Connectivity, ComponentsAreAppendedAndDropped) {
  Connectivity mesh = close(tube(6, 4));
  const auto before = live_faces(mesh);
  const Connectivity part = close(sheet(3, 3));
  mesh.append(close(sheet(3, 3)));
  ASSERT_NO_FATAL_FAILURE(expect_valid(mesh));
  EXPECT_EQ(mesh.vertex_count(), 24u + 9);
  EXPECT_EQ(mesh.loop_count(), 3u);
  mesh.append(close(sheet(3, 3)));
  ASSERT_NO_FATAL_FAILURE(expect_valid(mesh));
  EXPECT_EQ(mesh.loop_count(), 4u);
  for (int k = 0; k < 2; ++k)
    mesh.drop(part.vertex_count(), part.face_count(), part.loop_count());
  ASSERT_NO_FATAL_FAILURE(expect_valid(mesh));
  EXPECT_EQ(live_faces(mesh), before);
}

TEST(Connectivity, AComponentIsErasedVertexByVertex) {
  Connectivity mesh = close(tube(6, 4));
  const auto before = live_faces(mesh);
  mesh.append(close(sheet(3, 3)));
  for (VertexId v = 24; v < 33; ++v)
    mesh.erase(v);
  ASSERT_NO_FATAL_FAILURE(expect_valid(mesh));
  EXPECT_EQ(live_faces(mesh), before);
  EXPECT_EQ(mesh.loop_length(kVirtualBit + 2), 0u);
}

}  // namespace
}  // namespace vitrine::test
