// SPDX-License-Identifier: Apache-2.0
#include "codec/repair/repair.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "codec/repair/edge_groups.h"
#include "codec/repair/edge_pairs.h"
#include "codec/repair/face_texturing.h"
#include "codec/repair/keep_vertices.h"
#include "codec/repair/manifold.h"
#include "codec/repair/raw_mesh.h"

namespace vitrine::inline codec {
namespace {

// next steps in the lines of a report
constexpr std::string_view kRemove = "remove such parts in the source";
constexpr std::string_view kPart =
    "separate the surfaces in the source, if they are not one object";

// Counts the faces affected by one kind of repair. Stores the lowest number of an affected face.
struct Tally {
  std::uint64_t count = 0, first = 0;

  void add(std::uint64_t face) { first = count++ == 0 ? face : std::min(first, face); }
  // Appends a line to `out` if any face is affected. `step` tells the user what to do about the
  // fault.
  void report(std::string_view noun, std::string_view deed, std::string_view step,
              std::vector<std::string>& out) const {
    if (count == 0) return;
    out.push_back(counted(count, noun) + ' ' + std::string(deed) + ", first at face " +
                  std::to_string(first) + "; " + std::string(step));
  }
};

bool repeats_vertex(const Triangle& f) {
  return f[0] == f[1] || f[1] == f[2] || f[2] == f[0];
}

// Marks the faces at one edge that equal an earlier face. Also counts opposed faces: they have the
// same vertices as an earlier face, in opposite direction.
void mark_copies(std::span<const Triangle> faces, std::span<const EdgeSide> sides,
                 std::vector<bool>& marked, Tally& duplicates, Tally& opposed) {
  std::vector<std::array<std::uint32_t, 3>> order;  // each entry: apex, direction, face
  for (const EdgeSide& side : sides) {
    order.push_back({apex(faces, side.corner), runs_upwards(faces, side.corner), side.corner / 3});
  }
  std::sort(order.begin(), order.end());
  for (std::size_t i = 1; i < order.size(); ++i) {
    const auto &before = order[i - 1], &here = order[i];
    if (before[0] != here[0]) continue;
    if (before[1] != here[1]) {
      opposed.add(std::max(before[2], here[2]));
    } else {
      marked[here[2]] = true;
      duplicates.add(here[2]);
    }
  }
}

// An edge's smaller and larger vertex, and the opposite corner of a face at the edge.
using NamedSide = std::array<std::uint32_t, 3>;

// Whether the edge has exactly two faces that run in opposite directions. Two faces with the same
// three vertices do not count.
bool are_partners(std::span<const EdgeSide> sides, std::span<const Triangle> faces) {
  return sides.size() == 2 &&
         runs_upwards(faces, sides[0].corner) != runs_upwards(faces, sides[1].corner) &&
         apex(faces, sides[0].corner) != apex(faces, sides[1].corner);
}

class Repairer {
 public:
  explicit Repairer(ImportedMesh imported)
      : mesh_(std::move(imported.mesh)),
        texturing_(std::move(imported.texturing)),
        repairs_(std::move(imported.repairs)) {}

  Expected<RepairedMesh> run() {
    if (auto ok = check(); !ok) return tl::unexpected(ok.error());
    drop_degenerate();
    if (std::ranges::none_of(mesh_.faces, [&](const Triangle& f) { return has_area(f); }))
      return bad_input(
          "no face of the mesh has an area: the corners of each lie in one point or on "
          "one line; export the surface again");
    EdgeGroups groups = edges();
    if (drop_duplicates(groups)) groups = edges();
    if (orient(groups)) groups = edges();
    if (split(groups)) groups = edges();
    const std::uint64_t boundary_edges = count_boundary_edges(groups);
    drop_unreferenced();
    return finish(boundary_edges);
  }

 private:
  Expected<void> check() const {
    if (mesh_.positions.size() >= 0x8000'0000u || mesh_.faces.size() >= 0x5555'5555u) {
      return fail(ErrorCode::kLimit, "the mesh is too large for 32-bit indices; simplify it first");
    }
    for (std::size_t f = 0; f < mesh_.faces.size(); ++f) {
      if (std::ranges::max(mesh_.faces[f]) >= mesh_.positions.size()) {
        return bad_input("face " + std::to_string(f) +
                         " has a vertex index out of range; export it again");
      }
    }
    return {};
  }

  bool has_area(const Triangle& face) const {
    const auto& [a, b, c] = face;
    const std::vector<Vec3>& p = mesh_.positions;
    return cross(p[b] - p[a], p[c] - p[a]) != Vec3{};
  }

  void drop_degenerate() {
    Tally tally;
    std::vector<bool> marked(mesh_.faces.size(), false);
    for (std::size_t f = 0; f < mesh_.faces.size(); ++f) {
      if (!repeats_vertex(mesh_.faces[f])) continue;
      marked[f] = true;
      tally.add(f);
    }
    if (tally.count > 0) erase(marked);
    tally.report("degenerate face", "dropped", kRemove, repairs_);
  }

  // Removes each face that equals an earlier face. Equal faces share the edge between their two
  // smallest vertices, so only this edge is searched. Returns whether a face was removed.
  bool drop_duplicates(const EdgeGroups& groups) {
    Tally duplicates, opposed;
    std::vector<bool> marked(mesh_.faces.size(), false);
    std::vector<EdgeSide> lowest;
    groups.for_each([&](std::uint32_t low, std::span<const EdgeSide> sides) {
      if (sides.size() < 2) return;
      lowest.clear();
      for (const EdgeSide& side : sides) {
        const std::uint32_t tip = apex(mesh_.faces, side.corner);
        if (tip > low && tip > side.high) lowest.push_back(side);
      }
      if (lowest.size() > 1) mark_copies(mesh_.faces, lowest, marked, duplicates, opposed);
    });
    duplicates.first = source(duplicates.first);
    opposed.first = source(opposed.first);
    if (duplicates.count > 0) erase(marked);
    duplicates.report("duplicate face", "dropped", kRemove, repairs_);
    opposed.report("opposed face", "on the same vertices parted", kRemove, repairs_);
    return duplicates.count > 0;
  }

  bool orient(const EdgeGroups& groups) {
    const std::vector<std::uint32_t> reversed = orient_patches(mesh_.faces, groups);
    if (reversed.empty()) return false;
    for (const std::uint32_t f : reversed)
      reverse_face(texturing_, f);
    Tally{reversed.size(), source(reversed.front())}.report(
        "face", "reversed to agree with neighbours", "unify the normals in the source", repairs_);
    return true;
  }

  // Splits vertices until each has one fan. Returns whether any vertex was split.
  bool split(const EdgeGroups& groups) {
    report_bad_edges(groups);
    std::vector<std::uint32_t> across = pair_faces(mesh_.positions, mesh_.faces, groups);
    std::vector<Triangle> faces;
    std::vector<std::uint32_t> origins;
    // Splitting by fans suffices unless a surface folds back onto its own edge. In that case, some
    // edges stay tangled (see tangled_corners()). These edges are cut, and fans are split again. If
    // edges are still tangled, their faces are separated from all neighbours.
    for (const int corners_to_cut : {1, 3, 0}) {
      faces = mesh_.faces;
      origins = split_fans(vertex_count(), faces, across);
      const auto tangled = tangled_corners(groups, faces);
      if (tangled.empty()) break;
      for (const std::uint32_t c : tangled)
        cut(across, c, corners_to_cut);
    }
    report_split_vertices(origins);
    mesh_.faces = std::move(faces);
    for (const std::uint32_t v : origins) {
      mesh_.positions.push_back(mesh_.positions[v]);
      mesh_.attributes.duplicate(v);
    }
    return !origins.empty();
  }

  static void cut(std::vector<std::uint32_t>& across, std::uint32_t corner, int count) {
    const std::uint32_t base = corner - corner % 3;
    for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(count); ++k) {
      std::uint32_t& partner = across[base + (corner + k - base) % 3];
      if (partner == kNoPartner) continue;
      across[partner] = kNoPartner;
      partner = kNoPartner;
    }
  }

  // Returns the corners opposite to tangled edges. `groups` holds the edges before vertices were
  // split, and `faces` the faces after the split. An edge is tangled if it has more than two faces,
  // or two faces that are equal or run in the same direction.
  std::vector<std::uint32_t> tangled_corners(const EdgeGroups& groups,
                                             std::span<const Triangle> faces) const {
    std::vector<std::uint32_t> tangled;
    std::vector<NamedSide> named;
    groups.for_each([&](std::uint32_t, std::span<const EdgeSide> sides) {
      if (sides.size() < 2 || are_partners(sides, mesh_.faces)) return;
      named.clear();
      for (const EdgeSide& side : sides) {
        const Triangle& face = faces[side.corner / 3];
        const std::uint32_t a = face[(side.corner + 1) % 3], b = face[(side.corner + 2) % 3];
        named.push_back({std::min(a, b), std::max(a, b), side.corner});
      }
      std::sort(named.begin(), named.end());
      for (std::size_t i = 0, end; i < named.size(); i = end) {
        for (end = i + 1; end < named.size() && have_same_ends(named[end], named[i]);)
          ++end;
        if (is_sound(std::span(named).subspan(i, end - i), faces)) continue;
        for (; i < end; ++i)
          tangled.push_back(named[i][2]);
      }
    });
    return tangled;
  }

  static bool have_same_ends(const NamedSide& a, const NamedSide& b) {
    return a[0] == b[0] && a[1] == b[1];
  }

  static bool is_sound(std::span<const NamedSide> sides, std::span<const Triangle> faces) {
    if (sides.size() != 2) return sides.size() < 2;
    const std::array<EdgeSide, 2> pair{EdgeSide{0, sides[0][2]}, EdgeSide{0, sides[1][2]}};
    return are_partners(pair, faces);
  }

  void report_bad_edges(const EdgeGroups& groups) {
    Tally crowded, one_sided;
    groups.for_each([&](std::uint32_t, std::span<const EdgeSide> sides) {
      if (sides.size() > 2) crowded.add(source(sides[0].corner / 3));
      if (sides.size() != 2) return;
      const std::uint32_t a = sides[0].corner, b = sides[1].corner;
      if (runs_upwards(mesh_.faces, a) == runs_upwards(mesh_.faces, b)) {
        one_sided.add(source(a / 3));
      }
    });
    crowded.report("non-manifold edge", "split", kPart, repairs_);
    one_sided.report("edge", "cut where the surface has only one side", kPart, repairs_);
  }

  void report_split_vertices(std::vector<std::uint32_t> origins) {
    std::sort(origins.begin(), origins.end());
    origins.erase(std::unique(origins.begin(), origins.end()), origins.end());
    if (origins.empty()) return;
    repairs_.push_back(std::to_string(origins.size()) +
                       (origins.size() == 1 ? " vertex" : " vertices") +
                       " split to part fans, first at vertex " + std::to_string(origins[0]) + "; " +
                       std::string(kPart));
  }

  void drop_unreferenced() {
    const std::size_t dropped = keep_vertices(used_vertices(mesh_.positions.size(), mesh_.faces),
                                              mesh_.positions, mesh_.attributes, mesh_.faces);
    if (dropped == 0) return;
    repairs_.push_back(std::to_string(dropped) + " unreferenced " +
                       (dropped == 1 ? "vertex" : "vertices") + " dropped; " +
                       std::string(kRemove));
  }

  std::uint64_t count_components() const {
    std::vector<std::uint32_t> parent(mesh_.positions.size());
    std::iota(parent.begin(), parent.end(), 0);
    const auto root = [&](std::uint32_t v) {
      while (parent[v] != v)
        v = parent[v] = parent[parent[v]];
      return v;
    };
    std::uint64_t count = parent.size();
    for (const auto& [a, b, c] : mesh_.faces) {
      for (const std::uint32_t other : {b, c}) {
        const std::uint32_t x = root(a), y = root(other);
        if (x == y) continue;
        parent[std::max(x, y)] = std::min(x, y);
        --count;
      }
    }
    return count;
  }

  EdgeGroups edges() const { return EdgeGroups(mesh_.positions.size(), mesh_.faces); }

  static std::uint64_t count_boundary_edges(const EdgeGroups& groups) {
    std::uint64_t count = 0;
    groups.for_each(
        [&](std::uint32_t, std::span<const EdgeSide> sides) { count += sides.size() == 1; });
    return count;
  }

  RepairedMesh finish(std::uint64_t boundary_edges) {
    RepairedMesh result;
    result.boundary_edges = boundary_edges;
    result.components = count_components();
    result.mesh = std::move(mesh_);
    result.repairs = std::move(repairs_);
    result.texturing = std::move(texturing_);
    return result;
  }

  void erase(const std::vector<bool>& marked) {
    if (source_.empty()) {
      source_.resize(mesh_.faces.size());
      std::iota(source_.begin(), source_.end(), 0);
    }
    std::size_t kept = 0;
    for (std::size_t f = 0; f < marked.size(); ++f) {
      if (marked[f]) continue;
      source_[kept] = source_[f];
      mesh_.faces[kept++] = mesh_.faces[f];
    }
    source_.resize(kept);
    mesh_.faces.resize(kept);
    erase_faces(texturing_, marked);
  }

  // Returns the number that face f had in the input.
  std::uint64_t source(std::size_t f) const { return source_.empty() ? f : source_[f]; }

  std::uint32_t vertex_count() const { return static_cast<std::uint32_t>(mesh_.positions.size()); }

  TriangleMesh mesh_;
  Texturing texturing_;
  std::vector<std::string> repairs_;
  // Per face: its number in the input. Empty if no face was removed.
  std::vector<std::uint32_t> source_;
};

}  // namespace

Expected<RepairedMesh> repair(ImportedMesh imported) {
  return Repairer(std::move(imported)).run();
}

}  // namespace vitrine::inline codec
