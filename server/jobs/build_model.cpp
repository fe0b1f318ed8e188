// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/build_model.h"

#include <algorithm>
#include <chrono>
#include <deque>
#include <future>
#include <memory>
#include <set>

#include "codec/base/base_encoder.h"
#include "codec/import/read_mesh.h"
#include "codec/import/repair.h"
#include "codec/progressive/display_filter.h"
#include "codec/progressive/layer_encoder.h"
#include "codec/simplify/display_fit.h"
#include "codec/simplify/error_meter.h"
#include "codec/simplify/simplify.h"

namespace vitrine {
namespace {

class Stopwatch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

double median_edge(const TriangleMesh& mesh) {
  constexpr std::size_t kEdges = 30'000;
  std::vector<double> lengths;
  const std::size_t stride = mesh.faces.size() / kEdges + 1;
  for (std::size_t f = 0; f < mesh.faces.size(); f += stride) {
    const Triangle& t = mesh.faces[f];
    lengths.push_back(length(mesh.positions[t[0]] - mesh.positions[t[1]]));
  }
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return *middle;
}

// The coarsest grid whose step is at most 1/32 of the median edge.
int automatic_bits(const TriangleMesh& mesh) {
  const double edge = median_edge(mesh);
  int bits = kMinBits;
  while (bits < kMaxBits && fit_lattice(mesh.positions, bits).step > edge / 32)
    ++bits;
  return bits;
}

// So many that a chunk of the finest level, about half of all bytes, is some 28 KB.
std::uint32_t region_count(std::size_t vertices) {
  constexpr double kBytesPerVertex = 1.6, kFinestShare = 0.45, kChunkBytes = 28'000;
  const double finest = static_cast<double>(vertices) * kBytesPerVertex * kFinestShare;
  return static_cast<std::uint32_t>(std::clamp(finest / kChunkBytes + 0.5, 1.0, 4096.0));
}

Expected<Hierarchy> make_hierarchy(const LatticeMesh& fine, const BuildOptions& options,
                                   const BuildProgress& progress) {
  SimplifyOptions how{.placement = options.placement,
                      .regions = region_count(fine.positions.size())};
  if (progress) how.progress = [&](double done) { progress("simplify", 0.1 + 0.4 * done); };
  auto hierarchy = simplify(fine, how);
  // The fork into regions is coded behind the splits of a common level, so one is needed.
  if (hierarchy && hierarchy->regions > 1 && hierarchy->fork_level < 2) {
    how.regions = 1;
    hierarchy = simplify(fine, how);
  }
  return hierarchy;
}

std::vector<std::vector<std::uint32_t>> region_adjacency(const LatticeMesh& fine,
                                                         const Hierarchy& hierarchy) {
  std::vector<std::set<std::uint32_t>> sets(hierarchy.regions);
  for (const Triangle& t : fine.faces) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint16_t a = hierarchy.region[t[k]], b = hierarchy.region[t[(k + 1) % 3]];
      if (a != b) sets[a].insert(b), sets[b].insert(a);
    }
  }
  std::vector<std::vector<std::uint32_t>> adjacency;
  adjacency.reserve(sets.size());
  for (const auto& set : sets)
    adjacency.emplace_back(set.begin(), set.end());
  return adjacency;
}

// Measures levels, `threads` at a time, while the next ones are being coded.
class LevelErrors {
 public:
  // `fine` is `original` rounded to the lattice.
  LevelErrors(const TriangleMesh& original, const LatticeMesh& fine, unsigned threads)
      : meter_(original), fine_(fine), lattice_(fine.lattice), threads_(threads) {}

  // `last`: full resolution is shown as it is, which is `fine`.
  void add(const MeshState& level, bool last, Manifest& manifest) {
    LevelInfo info{.vertices = level.vertex_count()};
    if (!last) info.display_filter = fit_display_filter(level, lattice_, meter_.original());
    info.display_filter = static_cast<float>(info.display_filter);  // as the header stores it
    auto mesh = std::make_shared<TriangleMesh>();
    filter_for_display(
        level, [&](VertexId) { return info.display_filter; }, mesh->positions);
    for (Vec3& p : mesh->positions)
      p = lattice_.origin + p * lattice_.step;
    mesh->faces = level.real_faces();
    info.faces = static_cast<std::uint32_t>(mesh->faces.size());
    manifest.levels.push_back(info);
    while (pending_.size() + 1 >= threads_ && !pending_.empty())
      settle(manifest);
    pending_.push_back(
        std::async(threads_ > 1 ? std::launch::async : std::launch::deferred, [this, mesh, last] {
          return last ? meter_.measure_moved(to_model(fine_)) : meter_.measure(*mesh);
        }));
  }

  void finish(Manifest& manifest) {
    while (!pending_.empty())
      settle(manifest);
  }

 private:
  void settle(Manifest& manifest) {
    const LevelError error = pending_.front().get();
    pending_.pop_front();
    manifest.levels[settled_].max_error = error.max_error;
    manifest.levels[settled_].rms_error = error.rms_error;
    ++settled_;
  }

  ErrorMeter meter_;
  const LatticeMesh& fine_;
  Lattice lattice_;
  unsigned threads_;
  std::deque<std::future<LevelError>> pending_;
  std::size_t settled_ = 0;
};

Manifest frame_of(const Hierarchy& hierarchy, const LatticeMesh& fine) {
  Manifest m{.lattice = fine.lattice, .placement = hierarchy.placement};
  m.coloured = !fine.colours.empty();
  m.loops = hierarchy.loops;
  m.regions = hierarchy.regions;
  m.fork_level = hierarchy.fork_level;
  m.planes = hierarchy.planes;
  m.adjacency = region_adjacency(fine, hierarchy);
  return m;
}

Expected<EncodedBase> base_of(const Hierarchy& hierarchy) {
  return encode_base({.positions = hierarchy.base.positions,
                      .faces = hierarchy.base.faces,
                      .colours = hierarchy.base_colours});
}

void add_chunks(std::vector<EncodedChunk> chunks, std::uint32_t level, Manifest& manifest,
                std::vector<std::uint8_t>& body) {
  for (EncodedChunk& chunk : chunks) {
    manifest.chunks.push_back({.level = level,
                               .region = chunk.region,
                               .length = chunk.bytes.size(),
                               .splits = chunk.splits,
                               .sha256 = sha256(chunk.bytes)});
    body.insert(body.end(), chunk.bytes.begin(), chunk.bytes.end());
  }
}

// Codes all levels into `body`: the file without its header.
Expected<void> encode(const Hierarchy& hierarchy, const LatticeMesh& fine,
                      const TriangleMesh& original, const BuildOptions& options,
                      const BuildProgress& progress, Manifest& manifest,
                      std::vector<std::uint8_t>& body) {
  auto base = base_of(hierarchy);
  if (!base) return tl::unexpected(base.error());
  manifest.base_length = base->bytes.size();
  manifest.base_sha256 = sha256(base->bytes);
  body = base->bytes;

  std::vector<VertexId> fine_ids;
  for (const std::uint32_t v : base->original)
    fine_ids.push_back(hierarchy.base_ids[v]);
  auto encoder = LayerEncoder::start(hierarchy, base->decoded, std::move(fine_ids));
  if (!encoder) return tl::unexpected(encoder.error());
  const std::size_t levels = hierarchy.levels.size();
  LevelErrors errors(original, fine, options.threads);
  errors.add(encoder->mesh(), levels == 0, manifest);
  for (std::uint32_t level = 1; level <= levels; ++level) {
    auto chunks = encoder->encode_level();
    if (!chunks) return tl::unexpected(chunks.error());
    add_chunks(std::move(*chunks), level, manifest, body);
    errors.add(encoder->mesh(), level == levels, manifest);
    const double share = static_cast<double>(encoder->mesh().vertex_count()) /
                         static_cast<double>(fine.positions.size());
    if (progress) progress("encode", 0.5 + 0.4 * share);
  }
  errors.finish(manifest);
  return {};
}

}  // namespace

Expected<BuildResult> build_model(std::span<const std::uint8_t> input, const BuildOptions& options,
                                  const BuildProgress& progress) {
  Stopwatch watch;
  BuildResult out;
  BuildReport& report = out.report;
  auto imported = read_mesh(input);
  if (!imported) return tl::unexpected(imported.error());
  auto repaired = repair(std::move(*imported));
  if (!repaired) return tl::unexpected(repaired.error());
  const TriangleMesh& mesh = repaired->mesh;
  report.input = {.vertices = mesh.positions.size(),
                  .faces = mesh.faces.size(),
                  .boundary_edges = repaired->boundary_edges,
                  .components = repaired->components,
                  .repairs = std::move(repaired->repairs)};
  report.seconds.read = watch.lap();
  if (progress) progress("read", 0.1);

  const int bits = options.bits != 0 ? options.bits : automatic_bits(mesh);
  const LatticeMesh fine = quantise(mesh, fit_lattice(mesh.positions, bits));
  const auto hierarchy = make_hierarchy(fine, options, progress);
  if (!hierarchy) return tl::unexpected(hierarchy.error());
  report.seconds.simplify = watch.lap();

  std::vector<std::uint8_t> body;
  report.manifest = frame_of(*hierarchy, fine);
  if (auto ok = encode(*hierarchy, fine, mesh, options, progress, report.manifest, body); !ok) {
    return tl::unexpected(ok.error());
  }
  report.seconds.encode = watch.lap();

  out.file = write_header(report.manifest);
  out.file.insert(out.file.end(), body.begin(), body.end());
  report.seconds.write = watch.lap();
  if (progress) progress("write", 1.0);
  return out;
}

}  // namespace vitrine
