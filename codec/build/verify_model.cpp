// SPDX-License-Identifier: Apache-2.0
#include "codec/build/verify_model.h"

#include <fmt/core.h>

#include <random>

#include "codec/build/face_set.h"
#include "codec/build/open_model.h"
#include "codec/build/originals.h"
#include "codec/picture/decode_picture.h"
#include "codec/repair/repair.h"

namespace vitrine::inline codec {
namespace {

using ByteSpan = std::span<const std::uint8_t>;

constexpr std::uint32_t kOrders = 3;
constexpr std::size_t kStatesPerOrder = 4;  // number of intermediate states checked per order

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

// Checks that the box of each region contains all faces at the region's vertices. The planner
// relies on this.
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

// Checks that every corner of a face has texture coordinates inside the picture.
Expected<void> check_coordinates(const Refiner& refiner, const std::string& where) {
  const Wedges& wedges = refiner.wedges();
  if (wedges.empty()) return {};
  const Connectivity& faces = refiner.connectivity();
  const auto side = static_cast<std::int32_t>(refiner.manifest().texture.side);
  for (Corner c = 0; c < 3 * faces.face_count(); ++c) {
    if (!faces.is_real(c / 3)) continue;
    const WedgeId wedge = wedges.of(c);
    if (wedge == kNoWedge) return bad(fmt::format("a corner of {} has no coordinates", where));
    const Vec2i& at = wedges[wedge].at;
    if (at.x >= 0 && at.y >= 0 && at.x <= side && at.y <= side) continue;
    return bad(fmt::format("texture coordinates of {} are outside the picture", where));
  }
  return {};
}

Expected<void> check_picture(const Manifest& manifest, ByteSpan pmesh, std::size_t i) {
  const auto bytes = picture_of(manifest, pmesh, i);
  if (!bytes) return tl::unexpected(bytes.error());
  if (!is_webp(*bytes)) return bad(fmt::format("picture {} of the texture is not WebP", i));
  const std::uint64_t side = manifest.texture.pictures[i].side;
  const auto picture = decode_picture(*bytes, side * side);
  if (!picture) {
    return fail(picture.error().code,
                fmt::format("picture {} of the texture {}", i, picture.error().message));
  }
  if (picture->width == side && picture->height == side) return {};
  return bad(fmt::format("picture {} of the texture has {} x {} pixels and the header says {}", i,
                         picture->width, picture->height, side));
}

Expected<void> check_pictures(const Manifest& manifest, ByteSpan pmesh) {
  for (std::size_t i = 0; i < manifest.texture.pictures.size(); ++i) {
    if (auto ok = check_picture(manifest, pmesh, i); !ok) return ok;
  }
  return {};
}

Expected<void> check_optional_blocks(const Manifest& manifest, ByteSpan pmesh) {
  for (const OptionalBlock& block : manifest.optional_blocks) {
    if (const auto bytes = optional_block(block, pmesh); !bytes)
      return tl::unexpected(bytes.error());
  }
  return {};
}

// Returns the originals, or an empty texturing if the file has none.
Expected<Texturing> read_originals(const Refiner& refiner, ByteSpan pmesh) {
  if (!has_originals(refiner.manifest())) return Texturing{};
  return originals_of(refiner, pmesh);
}

Expected<void> check_level(const Refiner& refiner, std::uint32_t level) {
  const LevelInfo& stated = refiner.manifest().levels[level];
  if (refiner.vertex_count() != stated.vertices || refiner.face_count() != stated.faces) {
    return bad(fmt::format("level {} has {} vertices and {} faces, the header says {} and {}",
                           level, refiner.vertex_count(), refiner.face_count(), stated.vertices,
                           stated.faces));
  }
  if (auto ok = check_boxes(refiner, level); !ok) return ok;
  const std::string where = fmt::format("level {}", level);
  if (auto ok = check_coordinates(refiner, where); !ok) return ok;
  return check_manifold(refiner, where);
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
    if (auto ok = check_coordinates(*refiner, where); !ok) return tl::unexpected(ok.error());
  }
  return refiner;
}

// The faces of a refined model.
struct FinalFaces {
  std::vector<FaceKey> plain;
  std::vector<TexturedFaceKey> textured;
  bool operator==(const FinalFaces&) const = default;
};

FinalFaces final_faces(const Refiner& refiner) {
  return {face_set(refiner.lattice_mesh()), textured_face_set(refiner)};
}

// Refines the model in several random orders and once level by level. Each order must end with the
// faces `expected`. Returns the number of orders checked. A model with one region has only the
// order by level.
Expected<std::uint32_t> check_orders(ByteSpan pmesh, const Manifest& manifest,
                                     const FinalFaces& expected, const ProgressReport& progress) {
  if (manifest.tree.leaves() == 1) return 1;
  for (std::uint32_t seed = 1; seed <= kOrders; ++seed) {
    const auto refiner = refine_at_random(pmesh, seed);
    if (!refiner) return tl::unexpected(refiner.error());
    if (final_faces(*refiner) != expected) {
      return bad(fmt::format("random refinement order {} ends in another mesh", seed));
    }
    progress("orders", seed / double{kOrders});
  }
  return 1 + kOrders;
}

// Whether the input has the same faces and, if `originals` is not empty, the same materials,
// texture coordinates and pictures.
Expected<bool> equals_input(const std::vector<FaceKey>& faces, const Refiner& refiner,
                            const Texturing& originals, const OriginalFile& input) {
  const Manifest& manifest = refiner.manifest();
  auto imported = read_mesh(input.bytes, input.reading);
  if (!imported) return tl::unexpected(imported.error());
  const auto repaired = repair(std::move(*imported));
  if (!repaired) return tl::unexpected(repaired.error());
  const TriangleMesh& mesh = repaired->mesh;
  if (fit_lattice(mesh.positions, manifest.lattice.bits) != manifest.lattice) return false;
  if (mesh.attributes.semantics() != manifest.attributes) return false;
  const LatticeMesh quantised = quantise(mesh, manifest.lattice);
  if (face_set(quantised) != faces) return false;
  if (originals.empty()) return true;
  return !repaired->texturing.empty() && have_same_materials(originals, repaired->texturing) &&
         source_face_set(refiner.lattice_mesh(), originals) ==
             source_face_set(quantised, repaired->texturing);
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
  if (auto ok = check_pictures(manifest, pmesh); !ok) return tl::unexpected(ok.error());

  if (auto ok = check_optional_blocks(manifest, pmesh); !ok) return tl::unexpected(ok.error());
  const auto originals = read_originals(*refiner, pmesh);
  if (!originals) return tl::unexpected(originals.error());

  const FinalFaces faces = final_faces(*refiner);
  const auto orders = check_orders(pmesh, manifest, faces, progress);
  if (!orders) return tl::unexpected(orders.error());

  Verification result{.levels = static_cast<std::uint32_t>(manifest.levels.size()),
                      .chunks = manifest.chunks.size(),
                      .vertices = refiner->vertex_count(),
                      .faces = refiner->face_count(),
                      .pictures = manifest.texture.pictures.size(),
                      .has_originals = !originals->empty(),
                      .orders = *orders};
  if (input) {
    const auto equal = equals_input(faces.plain, *refiner, *originals, *input);
    if (!equal) return tl::unexpected(equal.error());
    result.is_lossless = *equal;
  }
  return result;
}

}  // namespace vitrine::inline codec
