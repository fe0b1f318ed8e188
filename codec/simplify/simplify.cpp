// SPDX-License-Identifier: Apache-2.0
#include "codec/simplify/simplify.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "codec/format/placement.h"
#include "codec/simplify/apply_collapse.h"
#include "codec/simplify/heap_order.h"
#include "codec/simplify/matching.h"
#include "codec/simplify/region_tree.h"
#include "codec/simplify/small_components.h"
#include "codec/simplify/surface.h"

namespace vitrine::inline codec {
namespace {

// Number of levels, starting with the finest, that keep a regular sampling
// (LevelRules::is_regular).
constexpr std::uint32_t kRegularLevels = 4;
// Weight of the edge length in the cost. With this weight, short edges collapse first. This matters
// most in the finest level, where the other costs are noise. Without this weight, coarser levels
// need more bytes.
constexpr double kFinestLengthWeight = 5e-3, kLengthWeight = 1e-3;
constexpr double kCellPerError = 1;  // side of a cell, relative to the rms distance from the planes
// A level that removes less than 1/50 of the vertices is the last one, unless small components can
// be removed next. Topology prevents most collapses in such a level, and further levels cost bytes.
constexpr std::uint32_t kLeastShare = 50;

Surface make_surface(const LatticeMesh& fine, Connectivity mesh, std::span<const Vec3> original) {
  Surface s{.mesh = std::move(mesh), .position = fine.positions};
  const double per_unit = 1 / fine.lattice.step;
  s.quadric = surface_quadrics(s.mesh, [&](VertexId v) {
    if (original.empty()) return to_vec3(fine.positions[v]);
    return (original[v] - fine.lattice.origin) * per_unit;
  });
  s.attributes = lattice_attributes(fine.attributes);
  s.live.resize(s.position.size());
  std::iota(s.live.begin(), s.live.end(), 0u);
  return s;
}

class Simplifier {
 public:
  Simplifier(Surface& surface, const Lattice& lattice, const SimplifyOptions& options,
             RegionTree& tree)
      : surface_(surface),
        options_(options),
        matcher_(surface, options.threads),
        regions_(tree),
        small_(surface) {
    const std::int32_t side = 1 << lattice.bits, margin = side / 4;
    low_ = {-margin, -margin, -margin};
    high_ = {side - 1 + margin, side - 1 + margin, side - 1 + margin};
  }

  // Simplifies the surface and writes the levels to `out`, from coarse to fine. Returns false if
  // the coarsest level has more than one region.
  bool run(Hierarchy& out) {
    out.levels = options_.order == CollapseOrder::kHeap ? run_heap() : run_batches();
    insertions_.resize(out.levels.size());
    out.insertions = std::move(insertions_);
    out.shift = std::move(shifts_);
    out.refined = std::move(refined_);
    std::ranges::reverse(out.levels);
    std::ranges::reverse(out.insertions);
    std::ranges::reverse(out.shift);
    std::ranges::reverse(out.refined);
    return regions_.finish(static_cast<std::uint32_t>(out.levels.size()));
  }

 private:
  bool is_small() const {
    return surface_.live.size() <= options_.target_vertices + options_.target_vertices / 4;
  }

  // run_batches() and the functions below it order levels from fine to coarse.
  std::vector<CollapseLevel> run_batches() {
    std::vector<CollapseLevel> levels;
    // The format requires that the coarsest level has only one region. If the last regions are
    // joined in a level, this level is added even if it has no collapses.
    bool enough = is_small(), shedding = false;
    while (levels.size() + 1 < Limits{}.levels && !(enough && regions_.is_whole())) {
      const std::size_t before = surface_.live.size();
      const bool was_whole = regions_.is_whole(), was_shedding = shedding;
      const auto from_finest = static_cast<std::uint32_t>(levels.size());
      join_regions(from_finest, enough);
      std::vector<Component> insertions = shed_components(shedding);
      CollapseLevel level = collapse_level(rules(from_finest));
      if (!level.empty() || !insertions.empty() || !was_whole) {
        levels.push_back(std::move(level));
        insertions_.push_back(std::move(insertions));
        coarsen_lattice();
        report();
      }
      // Also removes the smallest components if collapses alone remove too few vertices.
      const bool stuck = (before - surface_.live.size()) * kLeastShare < before;
      shedding |= stuck && options_.omits_components &&
                  small_.vertices() * kLeastShare >= surface_.live.size();
      enough = is_small() || (stuck && (was_shedding || !shedding));
    }
    return levels;
  }

  // Removes components that are hidden by the level's error. If `many` is true, collapses alone
  // remove too few vertices. In that case, also removes the smallest components until half of the
  // vertices are left.
  std::vector<Component> shed_components(bool many) {
    if (!options_.omits_components || small_.vertices() == 0) return {};
    const std::size_t now = surface_.live.size();
    const std::size_t fewer = std::max<std::size_t>(options_.target_vertices, now / 2);
    return small_.leave(surface_, {rms_error(), many ? fewer : now});
  }

  std::vector<CollapseLevel> run_heap() {
    join_regions(kRegularLevels, true);
    auto levels = collapse_by_heap(surface_, rules(kRegularLevels), options_.target_vertices,
                                   Limits{}.levels - 1);
    shifts_.resize(levels.size() + 1);
    refined_.resize(levels.size());
    return levels;
  }

  // Makes cells about as large as the level's error, because finer bits would cost bytes before
  // they are visible. The low bits that are removed here are coded again with the level's splits.
  void coarsen_lattice() {
    const std::uint32_t before = surface_.shift;
    const std::uint32_t wanted = splits_see_other_regions_ ? before : coarsest_shift();
    std::vector<Refined> refined;
    if (wanted > before) {
      refined.reserve(surface_.live.size());
      for (VertexId v : surface_.live) {
        refined.push_back({v, surface_.position[v]});
        surface_.position[v] = cell_of(surface_.position[v], wanted - before);
      }
      surface_.shift = wanted;
    }
    shifts_.push_back(surface_.shift);
    refined_.push_back(std::move(refined));
  }

  // Returns the rms distance, in lattice units, from the planes of the surface before rounding.
  double rms_error() const {
    double error = 0, weight = 0;
    for (VertexId v : surface_.live) {
      error += surface_.quadric[v].at(surface_.point(v));
      weight += surface_.quadric[v].weight();
    }
    return std::sqrt(std::max(error, 0.0) / std::max(weight, 1e-9));
  }

  std::uint32_t coarsest_shift() const {
    const double step = kCellPerError * rms_error();
    std::uint32_t shift = surface_.shift;
    while (shift < kMaxShift && static_cast<double>(2u << shift) <= step)
      ++shift;
    return shift;
  }

  void join_regions(std::uint32_t from_finest, bool in_one) {
    // The finest level has all leaves as regions, so no regions are joined for this level.
    const bool join_all = in_one && from_finest > 0;
    regions_.join(surface_.live, join_all ? UINT32_MAX : options_.region_vertices, surface_.region);
  }

  LevelRules rules(std::uint32_t from_finest) {
    splits_see_other_regions_ = !regions_.is_whole() && options_.placement == Placement::kPyramid;
    const auto live = static_cast<std::uint32_t>(surface_.live.size());
    return {.placement = options_.placement,
            .parity = static_cast<std::int32_t>(from_finest & 1),
            .keeps_regions = !regions_.is_whole(),
            .length_weight = from_finest == 0 ? kFinestLengthWeight : kLengthWeight,
            .is_regular = from_finest < kRegularLevels,
            .most = live - std::min(live, options_.target_vertices),
            .low = cell_of(low_, surface_.shift),
            .high = cell_of(high_, surface_.shift)};
  }

  CollapseLevel collapse_level(const LevelRules& rules) {
    CollapseLevel level;
    const std::vector<Pick>& picks = matcher_.match(rules);
    level.reserve(picks.size());
    // Earlier collapses of this level may have changed the surroundings of the edge, so the edge is
    // checked again.
    for (const Pick& pick : picks) {
      const EdgeStar edge(surface_.mesh, pick.corner);
      if (keeps_manifold(surface_.mesh, edge) && matcher_.keeps_shape(edge, pick.target)) {
        level.push_back(apply_collapse(surface_, edge, pick));
      }
    }
    std::erase_if(surface_.live,
                  [&](VertexId v) { return surface_.mesh.corner_at(v) == kNoCorner; });
    return level;
  }

  void report() const {
    if (!options_.progress) return;
    options_.progress(1 - static_cast<double>(surface_.live.size()) /
                              static_cast<double>(surface_.position.size()));
  }

  Surface& surface_;
  const SimplifyOptions& options_;
  CollapseMatcher matcher_;
  Vec3i low_, high_;
  RegionJoiner regions_;
  SmallComponents small_;
  // Whether merged positions depend on exact positions in other regions.
  bool splits_see_other_regions_ = false;
  std::vector<std::uint32_t> shifts_{0};
  std::vector<std::vector<Refined>> refined_;
  std::vector<std::vector<Component>> insertions_;
};

void compact_base(const Surface& surface, const Lattice& lattice, Hierarchy& out) {
  out.base.lattice = lattice;
  out.base_ids = surface.live;
  add_columns(out.base_attributes, surface.attributes);
  std::vector<std::uint32_t> index(surface.position.size());
  for (std::uint32_t i = 0; i < surface.live.size(); ++i) {
    const VertexId v = surface.live[i];
    index[v] = i;
    out.base.positions.push_back(surface.position[v]);
    append_row(out.base_attributes, surface.attributes, v);
  }
  const Connectivity& mesh = surface.mesh;
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    if (mesh.is_dead(f) || !mesh.is_real(f)) continue;
    out.base.faces.push_back(
        {index[mesh.vertex(3 * f)], index[mesh.vertex(3 * f + 1)], index[mesh.vertex(3 * f + 2)]});
  }
}

// Simplifies `fine`. Returns nullopt if the coarsest level would have more than one region.
Expected<std::optional<Hierarchy>> try_simplify(const LatticeMesh& fine,
                                                const SimplifyOptions& options,
                                                std::span<const Vec3> original) {
  auto mesh = Connectivity::close(static_cast<std::uint32_t>(fine.positions.size()), fine.faces);
  if (!mesh) return tl::unexpected(mesh.error());

  Hierarchy out{.placement = options.placement};
  out.loops = mesh->loop_count();
  const std::uint32_t capacity = options.region_vertices;
  RegionLabels labels = label_regions(fine.positions, capacity == 0 ? UINT32_MAX : capacity);
  out.leaf = labels.leaf;
  out.adjacency = leaf_adjacency(fine.faces, labels);

  Surface surface = make_surface(fine, std::move(*mesh), original);
  surface.region = std::move(labels.leaf);
  Simplifier simplifier(surface, fine.lattice, options, labels.tree);
  if (!simplifier.run(out)) return std::optional<Hierarchy>();
  out.tree = std::move(labels.tree);
  compact_base(surface, fine.lattice, out);
  return std::optional(std::move(out));
}

}  // namespace

Expected<Hierarchy> simplify(const LatticeMesh& fine, const SimplifyOptions& options,
                             std::span<const Vec3> original) {
  const bool parted = options.order == CollapseOrder::kBatch;
  SimplifyOptions whole = options;
  whole.region_vertices = 0;
  auto hierarchy = try_simplify(fine, parted ? options : whole, original);
  if (!hierarchy) return tl::unexpected(hierarchy.error());
  if (*hierarchy) return std::move(**hierarchy);
  return std::move(**try_simplify(fine, whole, original));
}

}  // namespace vitrine::inline codec
