// SPDX-License-Identifier: Apache-2.0
#include "support/random_atlas.h"

#include "codec/mesh/connectivity.h"
#include "support/product_names.h"
#include "support/random_mesh.h"

namespace vitrine::test {
namespace {

constexpr std::uint32_t kNone = 0xFFFF'FFFFu;

// Returns the chart of each face. The faces of a chart are those nearest to one of several random
// faces.
std::vector<std::uint32_t> random_charts(const BaseMesh& base, Dice& dice) {
  const auto faces = static_cast<std::uint32_t>(base.faces.size());
  std::vector<std::uint32_t> seeds(1 + dice.below(6));
  for (std::uint32_t& seed : seeds)
    seed = dice.below(faces);
  const auto first_corner = [&](std::uint32_t face) { return base.positions[base.faces[face][0]]; };
  std::vector<std::uint32_t> charts;
  for (std::uint32_t f = 0; f < faces; ++f) {
    const auto distance = [&](std::uint32_t seed) {
      const Vec3 d = to_vec3(first_corner(seed) - first_corner(f));
      return dot(d, d);
    };
    std::uint32_t nearest = 0;
    for (std::uint32_t k = 1; k < seeds.size(); ++k)
      if (distance(seeds[k]) < distance(seeds[nearest])) nearest = k;
    charts.push_back(nearest);
  }
  return charts;
}

// Returns for each corner whether the opposite edge is cut.
std::vector<bool> random_seams(const Connectivity& mesh, const std::vector<std::uint32_t>& charts,
                               Dice& dice) {
  const auto corners = static_cast<Corner>(3 * charts.size());
  const std::uint32_t rarity = 2 + dice.below(30);
  std::vector<bool> is_seam(corners, true);
  for (Corner c = 0; c < corners; ++c) {
    const Corner across = mesh.opposite(c);
    if (across >= corners || across < c) continue;
    is_seam[c] = is_seam[across] = charts[c / 3] != charts[across / 3] || dice.one_in(rarity);
  }
  return is_seam;
}

}  // namespace

BaseAtlas random_atlas(const BaseMesh& base, std::uint64_t seed) {
  Dice dice(seed);
  const auto mesh =
      Connectivity::close(static_cast<std::uint32_t>(base.positions.size()), base.faces).value();
  const auto charts = random_charts(base, dice);
  const auto is_seam = random_seams(mesh, charts, dice);
  const bool is_flat = !dice.one_in(3);
  std::vector<Vec2i> offsets(6);
  for (Vec2i& offset : offsets)
    offset = {dice.between(0, 1 << 18), dice.between(0, 1 << 18)};
  std::vector<std::uint32_t> wedge(3 * charts.size(), kNone);
  BaseAtlas atlas;
  for (Corner c = 0; c < wedge.size(); ++c) {
    if (wedge[c] != kNone) continue;
    const auto number = static_cast<std::uint32_t>(atlas.coordinates.size());
    Corner first = c;  // the clockwise end of the wedge; the loop below goes counter-clockwise
    while (!is_seam[prev(first)] && prev(mesh.opposite(prev(first))) != c)
      first = prev(mesh.opposite(prev(first)));
    for (Corner d = first; wedge[d] == kNone;) {
      wedge[d] = number;
      if (is_seam[next(d)]) break;
      d = mesh.swing(d);
    }
    const Vec3i& p = base.positions[mesh.vertex(c)];
    const Vec2i projected = Vec2i{p.x + (1 << 17), p.y + (1 << 17)} + offsets[charts[c / 3]];
    atlas.coordinates.push_back(
        is_flat ? projected : Vec2i{dice.between(0, 1 << 20), dice.between(0, 1 << 20)});
  }
  for (std::size_t f = 0; f < charts.size(); ++f)
    atlas.wedges.push_back({wedge[3 * f], wedge[3 * f + 1], wedge[3 * f + 2]});
  return atlas;
}

}  // namespace vitrine::test
