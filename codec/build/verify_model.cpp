// SPDX-License-Identifier: Apache-2.0
#include "codec/build/verify_model.h"

#include <fmt/core.h>

#include <random>

#include "codec/build/face_set.h"
#include "codec/build/open_model.h"
#include "codec/repair/repair.h"

namespace vitrine::inline codec {
namespace {

using ByteSpan = std::span<const std::uint8_t>;

constexpr std::uint32_t kOrders = 3;
constexpr std::size_t kStatesPerOrder = 4;  // number of intermediate states to check

Unexpected bad(const std::string& what) {
  return fail(ErrorCode::kBadInput, what + "; build the file again");
}

Expected<void> check_size(const Manifest& manifest, std::uint64_t size) {
  if (manifest.file_bytes == size) return {};
  return bad(
      fmt::format("the file has {} bytes and its header says {}", size, manifest.file_bytes));
}

Expected<void> check_manifold(const Refiner& refiner, const std::string& where) {
  const LatticeMesh mesh = refiner.lattice_mesh();
  const auto closed =
      Connectivity::close(static_cast<std::uint32_t>(mesh.positions.size()), mesh.faces);
  if (!closed) return bad(fmt::format("{} is not a manifold: {}", where, closed.error().message));
  const std::uint32_t loops = refiner.connectivity().loop_count();
  if (closed->loop_count() == loops) return {};
  return bad(fmt::format("{} has {} boundary loops and its splits keep {}", where,
                         closed->loop_count(), loops));
}

Expected<void> check_loops(const Refiner& refiner) {
  const std::uint32_t loops = refiner.connectivity().loop_count();
  if (loops == refiner.manifest().loops) return {};
  return bad(fmt::format("full resolution has {} boundary loops and the header says {}", loops,
                         refiner.manifest().loops));
}

// Checks that the box of each region contains all faces at the region's vertices. Planners rely on
// this.
Expected<void> check_boxes(const Refiner& refiner, std::uint32_t level) {
  const Manifest& manifest = refiner.manifest();
  std::vector<const LatticeBox*> box(manifest.tree.leaves());
  for (const std::uint32_t node : manifest.tree.regions_at(level + 1))
    box[manifest.tree.nodes[node].first] = &manifest.tree.nodes[node].box;
  const Connectivity& faces = refiner.connectivity();
  for (Corner c = 0; c < 3 * faces.face_count(); ++c) {
    if (!faces.is_real(c / 3)) continue;
    const LatticeBox& around = *box[refiner.region_of(faces.vertex(c))];
    for (const Corner each : {c, next(c), prev(c)}) {
      if (around.holds(refiner.positions()[faces.vertex(each)])) continue;
      return bad(fmt::format("a face of level {} is outside of the box of its region", level));
    }
  }
  return {};
}

// Checks that the error stated for a level is at most the largest error stated for its chunks.
Expected<void> check_errors(const Manifest& manifest) {
  std::vector<double> worst(manifest.levels.size());
  for (const ChunkInfo& chunk : manifest.chunks)
    worst[chunk.level] = std::max(worst[chunk.level], chunk.max_error);
  for (std::size_t level = 1; level < worst.size(); ++level) {
    const double stated = manifest.levels[level].max_error;
    if (worst[level] >= stated) continue;
    return bad(fmt::format("level {} states an error of {} and its chunks one of {}", level, stated,
                           worst[level]));
  }
  return {};
}

Expected<void> check_level(const Refiner& refiner, std::uint32_t level) {
  const LevelInfo& stated = refiner.manifest().levels[level];
  if (refiner.vertex_count() != stated.vertices || refiner.face_count() != stated.faces) {
    return bad(fmt::format("level {} has {} vertices and {} faces, the header says {} and {}",
                           level, refiner.vertex_count(), refiner.face_count(), stated.vertices,
                           stated.faces));
  }
  if (auto ok = check_boxes(refiner, level); !ok) return ok;
  return check_manifold(refiner, fmt::format("level {}", level));
}

Expected<void> apply(Refiner& refiner, std::size_t chunk, ByteSpan pmesh) {
  const auto bytes = chunks_of(refiner.manifest(), pmesh)(chunk);
  if (!bytes) return tl::unexpected(bytes.error());
  return refiner.apply(chunk, *bytes);
}

Expected<Refiner> refine_by_level(ByteSpan pmesh, const ProgressReport& progress) {
  auto refiner = open_model(pmesh);
  if (!refiner) return refiner;
  if (auto ok = check_level(*refiner, 0); !ok) return tl::unexpected(ok.error());
  const auto& chunks = refiner->manifest().chunks;
  for (std::size_t i = 0; i < chunks.size(); ++i) {
    if (auto ok = apply(*refiner, i, pmesh); !ok) return tl::unexpected(ok.error());
    if (i + 1 < chunks.size() && chunks[i + 1].level == chunks[i].level) continue;
    if (auto ok = check_level(*refiner, chunks[i].level); !ok) return tl::unexpected(ok.error());
    progress("levels", static_cast<double>(i + 1) / static_cast<double>(chunks.size()));
  }
  return refiner;
}

std::vector<std::size_t> ready_chunks(const Refiner& refiner) {
  std::vector<std::size_t> ready;
  for (std::size_t i = 0; i < refiner.manifest().chunks.size(); ++i) {
    if (refiner.is_ready(i)) ready.push_back(i);
  }
  return ready;
}

Expected<Refiner> refine_at_random(ByteSpan pmesh, std::uint32_t seed) {
  auto refiner = open_model(pmesh);
  if (!refiner) return refiner;
  std::mt19937 random(seed);
  const std::size_t count = refiner->manifest().chunks.size();
  const std::size_t stride = count / kStatesPerOrder + 1;
  for (std::size_t applied = 1; applied <= count; ++applied) {
    const auto ready = ready_chunks(*refiner);
    if (ready.empty()) return bad(fmt::format("no chunk fits after {} of {}", applied - 1, count));
    const std::size_t chunk = ready[random() % ready.size()];
    if (auto ok = apply(*refiner, chunk, pmesh); !ok) return tl::unexpected(ok.error());
    if (applied % stride != 0) continue;
    const auto where = fmt::format("the state after {} chunks of random order {}", applied, seed);
    if (auto ok = check_manifold(*refiner, where); !ok) return tl::unexpected(ok.error());
  }
  return refiner;
}

// Refines in random orders, each of which must end with the faces `expected`. Returns the number of
// orders checked, including the order by level. A model with one region has only that order.
Expected<std::uint32_t> check_orders(ByteSpan pmesh, const Manifest& manifest,
                                     const std::vector<FaceKey>& expected,
                                     const ProgressReport& progress) {
  if (manifest.tree.leaves() == 1) return 1;
  for (std::uint32_t seed = 1; seed <= kOrders; ++seed) {
    const auto refiner = refine_at_random(pmesh, seed);
    if (!refiner) return tl::unexpected(refiner.error());
    if (face_set(refiner->lattice_mesh()) != expected) {
      return bad(fmt::format("random refinement order {} ends in another mesh", seed));
    }
    progress("orders", seed / double{kOrders});
  }
  return 1 + kOrders;
}

Expected<bool> equals_input(const std::vector<FaceKey>& faces, const Manifest& manifest,
                            const OriginalFile& input) {
  auto imported = read_mesh(input.bytes, input.reading);
  if (!imported) return tl::unexpected(imported.error());
  const auto repaired = repair(std::move(*imported));
  if (!repaired) return tl::unexpected(repaired.error());
  const TriangleMesh& mesh = repaired->mesh;
  if (fit_lattice(mesh.positions, manifest.lattice.bits) != manifest.lattice) return false;
  if (mesh.attributes.semantics() != manifest.attributes) return false;
  return face_set(quantise(mesh, manifest.lattice)) == faces;
}

}  // namespace

Expected<Verification> verify_model(ByteSpan pmesh, const std::optional<OriginalFile>& input,
                                    const ProgressReport& progress) {
  const auto refiner = refine_by_level(pmesh, progress);
  if (!refiner) return tl::unexpected(refiner.error());
  const Manifest& manifest = refiner->manifest();
  if (auto ok = check_size(manifest, pmesh.size()); !ok) return tl::unexpected(ok.error());
  if (auto ok = check_errors(manifest); !ok) return tl::unexpected(ok.error());
  if (auto ok = check_loops(*refiner); !ok) return tl::unexpected(ok.error());

  const auto faces = face_set(refiner->lattice_mesh());
  const auto orders = check_orders(pmesh, manifest, faces, progress);
  if (!orders) return tl::unexpected(orders.error());

  Verification result{.levels = static_cast<std::uint32_t>(manifest.levels.size()),
                      .chunks = manifest.chunks.size(),
                      .vertices = refiner->vertex_count(),
                      .faces = refiner->face_count(),
                      .orders = *orders};
  if (input) {
    const auto equal = equals_input(faces, manifest, *input);
    if (!equal) return tl::unexpected(equal.error());
    result.is_lossless = *equal;
  }
  return result;
}

}  // namespace vitrine::inline codec
