// SPDX-License-Identifier: Apache-2.0
#include "codec/atlas/draw_atlas.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdio>

#include "codec/atlas/pack.h"
#include "support/random_mesh.h"
#include "support/seeds.h"

namespace vitrine::test {
namespace {

struct Mesh {
  std::vector<Vec3> positions;
  std::vector<Triangle> faces;

  Atlas draw() const { return draw_atlas(positions, faces); }
};

Mesh random(std::uint64_t seed, std::uint32_t size = 120) {
  const LatticeMesh lattice = random_mesh(seed, size);
  Mesh mesh{{}, lattice.faces};
  for (const Vec3i& p : lattice.positions)
    mesh.positions.push_back(to_vec3(p));
  return mesh;
}

// A tube: a grid of u by v vertices that is closed in the direction of u. `place(i, j)` returns the
// position of a vertex.
template <class Place>
Mesh tube(std::uint32_t u, std::uint32_t v, const Place& place) {
  Mesh mesh;
  for (std::uint32_t j = 0; j < v; ++j) {
    for (std::uint32_t i = 0; i < u; ++i)
      mesh.positions.push_back(place(i, j));
  }
  for (std::uint32_t j = 0; j + 1 < v; ++j) {
    for (std::uint32_t i = 0; i < u; ++i) {
      const std::uint32_t a = j * u + i, b = j * u + (i + 1) % u;
      mesh.faces.push_back({a, b, b + u});
      mesh.faces.push_back({a, b + u, a + u});
    }
  }
  return mesh;
}

// A sphere of radius 1 without its poles.
Mesh globe(std::uint32_t u, std::uint32_t v) {
  return tube(u, v, [=](std::uint32_t i, std::uint32_t j) {
    const double east = 6.283185307179586 * i / u, north = 2.8 * (j / (v - 1.0) - 0.5);
    return Vec3{std::cos(north) * std::cos(east), std::cos(north) * std::sin(east),
                std::sin(north)};
  });
}

double doubled_uv_area(const Atlas& atlas, std::size_t face) {
  const auto& [a, b, c] = atlas.wedges[face];
  const auto &p = atlas.uv[a], &q = atlas.uv[b], &r = atlas.uv[c];
  return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
}

std::size_t flipped_faces(const Atlas& atlas) {
  std::size_t flipped = 0;
  for (std::size_t f = 0; f < atlas.wedges.size(); ++f)
    flipped += doubled_uv_area(atlas, f) > 0 ? 0 : 1;
  return flipped;
}

void expect_whole(const Mesh& mesh, const Atlas& atlas) {
  ASSERT_EQ(atlas.wedges.size(), mesh.faces.size());
  ASSERT_EQ(atlas.chart.size(), atlas.uv.size());
  std::vector<std::uint32_t> vertex(atlas.uv.size(), 0xFFFF'FFFF), faces(atlas.charts, 0);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto& wedges = atlas.wedges[f];
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_LT(wedges[k], atlas.uv.size());
      ASSERT_EQ(atlas.chart[wedges[k]], atlas.chart[wedges[0]]) << "face " << f;
      std::uint32_t& v = vertex[wedges[k]];
      ASSERT_TRUE(v == 0xFFFF'FFFF || v == mesh.faces[f][k]) << "wedge of two vertices";
      v = mesh.faces[f][k];
    }
    ASSERT_LT(atlas.chart[wedges[0]], atlas.charts);
    ++faces[atlas.chart[wedges[0]]];
  }
  for (const std::uint32_t n : faces)
    EXPECT_GT(n, 0u) << "a chart without faces";
  for (std::size_t w = 0; w < atlas.uv.size(); ++w) {
    ASSERT_NE(vertex[w], 0xFFFF'FFFF) << "a wedge without faces";
    ASSERT_TRUE(std::isfinite(atlas.uv[w][0]) && std::isfinite(atlas.uv[w][1]));
  }
}

std::vector<ChartTriangles> triangles_of(const Atlas& atlas) {
  std::vector<ChartTriangles> charts(atlas.charts);
  for (const auto& [a, b, c] : atlas.wedges)
    charts[atlas.chart[a]].push_back({atlas.uv[a], atlas.uv[b], atlas.uv[c]});
  return charts;
}

// The share of the texture square that at least one face covers, and the share that several faces
// cover.
struct Cover {
  double once = 0, twice = 0;
};

bool holds(const std::array<std::array<double, 2>, 3>& t, double x, double y) {
  for (std::size_t k = 0; k < 3; ++k) {
    const auto &p = t[k], &q = t[(k + 1) % 3];
    if ((q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]) <= 0) return false;
  }
  return true;
}

Cover cover(const Atlas& atlas, std::uint32_t points) {
  const std::vector<ChartTriangles> charts = triangles_of(atlas);
  const Packing packing = pack(charts);
  Dice dice(1);
  const auto number = [&] { return static_cast<double>(dice.bits() >> 11) / 9007199254740992.0; };
  Cover cover;
  for (std::uint32_t i = 0; i < points; ++i) {
    const double x = number(), y = number();
    int faces = 0;
    for (std::size_t c = 0; c < charts.size(); ++c) {
      const double u = (x - packing.offset[c][0]) / packing.scale;
      const double v = (y - packing.offset[c][1]) / packing.scale;
      for (const auto& triangle : charts[c])
        faces += holds(triangle, u, v) ? 1 : 0;
    }
    cover.once += faces > 0 ? 1.0 / points : 0;
    cover.twice += faces > 1 ? 1.0 / points : 0;
  }
  return cover;
}

TEST(DrawAtlas, EachFaceOfAnyMeshHasThreeWedgesOfOneChart) {
  for (std::uint64_t seed = 1; seed <= seeds(100); ++seed) {
    SCOPED_TRACE(seed);
    const Mesh mesh = random(seed);
    ASSERT_NO_FATAL_FAILURE(expect_whole(mesh, mesh.draw()));
  }
}

TEST(DrawAtlas, NoFaceIsFlippedNotEvenInCrowdedMeshes) {
  for (std::uint64_t seed = 1; seed <= seeds(100); ++seed)
    EXPECT_EQ(flipped_faces(random(seed).draw()), 0u) << "seed " << seed;
}

TEST(DrawAtlas, ASmoothSurfaceIsHardlyStretched) {
  const Mesh mesh = globe(60, 30);
  const Atlas atlas = mesh.draw();
  EXPECT_LE(atlas.charts, 48u);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto& [a, b, c] = mesh.faces[f];
    const Vec3 &p = mesh.positions[a], &q = mesh.positions[b], &r = mesh.positions[c];
    const double ratio = doubled_uv_area(atlas, f) / length(cross(q - p, r - p));
    EXPECT_GT(ratio, 0.7) << "face " << f;
    EXPECT_LT(ratio, 1.4) << "face " << f;
  }
}

TEST(DrawAtlas, ChartsOverlapNeitherThemselvesNorEachOther) {
  for (const Mesh& mesh : {globe(40, 20), random(7, 400), random(20, 400)}) {
    const Cover covered = cover(mesh.draw(), 5000);
    std::printf("%zu faces: %.3f covered\n", mesh.faces.size(), covered.once);
    EXPECT_GT(covered.once, 0.25);
    EXPECT_LE(covered.twice, 0.004 * covered.once);
  }
}

TEST(DrawAtlas, NeedlesAndFacesWithoutAreaGetRoomInThePlane) {
  const Mesh needles = tube(12, 9, [](std::uint32_t i, std::uint32_t j) {
    return Vec3{i < 6 ? i * 1.0 : 12.0 - i, i < 6 ? 0.0 : 1e-7, j % 2 == 0 ? j * 1.0 : j - 1.0};
  });
  const Atlas atlas = needles.draw();
  expect_whole(needles, atlas);
  EXPECT_EQ(flipped_faces(atlas), 0u);
}

TEST(DrawAtlas, FacesThatAreNoManifoldAreCutApart) {
  // Three faces share an edge, one face occurs twice, and one face repeats a vertex.
  const Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -1, 0}},
                  {{0, 1, 2}, {1, 0, 3}, {1, 0, 4}, {0, 1, 2}, {3, 3, 4}}};
  const Atlas atlas = mesh.draw();
  expect_whole(mesh, atlas);
  EXPECT_EQ(flipped_faces(atlas), 0u);
}

TEST(DrawAtlas, AnEmptyMeshHasAnEmptyAtlas) {
  const Atlas atlas = draw_atlas({}, {});
  EXPECT_EQ(atlas.charts, 0u);
  EXPECT_TRUE(atlas.wedges.empty());
}

TEST(DrawAtlas, EveryMachineDrawsTheSameBits) {
  std::uint64_t hash = 14695981039346656037u;  // FNV-1a over words
  for (const std::uint64_t seed : {2, 7, 20}) {
    for (const auto& uv : random(seed, 300).draw().uv) {
      for (const double x : uv)
        hash = (hash ^ std::bit_cast<std::uint64_t>(x)) * 1099511628211u;
    }
  }
  EXPECT_EQ(hash, 4915158963357038210u);
}

}  // namespace
}  // namespace vitrine::test
