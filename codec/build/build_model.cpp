// SPDX-License-Identifier: Apache-2.0
#include "codec/build/build_model.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "codec/build/level_errors.h"
#include "codec/build/model_encoder.h"
#include "codec/repair/repair.h"
#include "codec/simplify/order_in_space.h"
#include "codec/simplify/simplify.h"

namespace vitrine::inline codec {
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

// Returns the number of bits per coordinate of the coarsest lattice whose step is at most 1/32 of
// the median edge length.
int automatic_bits(const TriangleMesh& mesh) {
  const double edge = median_edge(mesh);
  int bits = kMinBits;
  while (bits < kMaxBits && fit_lattice(mesh.positions, bits).step > edge / 32)
    ++bits;
  return bits;
}

// Measured shares of a build's time that have passed at the end of reading, of simplification and
// of encoding. They convert the progress of each stage to that of the whole build.
constexpr double kRead = 0.02, kSimplified = 0.3, kEncoded = 0.99;
// Share of the encoding time that is the same for every level. The rest is proportional to the
// number of vertices that a level adds.
constexpr double kPerLevel = 0.27;

SimplifyOptions simplify_options(const LatticeMesh& fine, const BuildOptions& options,
                                 const ProgressReport& progress) {
  // With only two regions, a viewer could skip few bytes, and the second region costs bytes itself.
  const bool few = fine.positions.size() <= 2 * std::size_t{options.region_vertices};
  SimplifyOptions how{.placement = options.placement,
                      .order = options.order,
                      .region_vertices = few ? 0 : options.region_vertices};
  if (progress)
    how.progress = [&](double done) { progress("simplify", std::lerp(kRead, kSimplified, done)); };
  return how;
}

Expected<EncodedModel> encode(Hierarchy hierarchy, LevelErrors& errors,
                              const ProgressReport& progress) {
  const std::size_t levels = hierarchy.levels.size();
  const auto vertices = static_cast<double>(hierarchy.leaf.size());
  std::size_t level = 0;
  auto model = encode_model(std::move(hierarchy), [&](const MeshState& mesh) {
    errors.add(mesh, level == levels);
    if (level++ == 0 || !progress) return;
    const double share =
        std::lerp(static_cast<double>(mesh.vertex_count()) / vertices,
                  static_cast<double>(level) / static_cast<double>(levels + 1), kPerLevel);
    progress("encode", std::lerp(kSimplified, kEncoded, share));
  });
  if (model) errors.finish(model->manifest);
  return model;
}

// Lets the kernel page out a memory-mapped file that has been read. Has no harmful effect on other
// memory.
void let_go(std::span<const std::uint8_t> input) {
  const auto page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
  const auto begin = reinterpret_cast<std::uintptr_t>(input.data()) / page * page;
  const auto end = reinterpret_cast<std::uintptr_t>(input.data() + input.size());
  ::madvise(reinterpret_cast<void*>(begin), end - begin, MADV_PAGEOUT);
}

}  // namespace

Expected<BuildResult> build_model(std::span<const std::uint8_t> input, const BuildOptions& options,
                                  const ProgressReport& progress) {
  Stopwatch watch;
  auto imported = read_mesh(input, options.reading);
  if (!imported) return tl::unexpected(imported.error());
  let_go(input);
  const double seconds = watch.lap();
  auto result = build_model(std::move(*imported), options, progress);
  if (result) result->report.seconds.read += seconds;
  return result;
}

Expected<BuildResult> build_model(ImportedMesh imported, const BuildOptions& options,
                                  const ProgressReport& progress) {
  Stopwatch watch;
  BuildResult out;
  BuildReport& report = out.report;
  const std::string unit = imported.unit;
  imported.texturing = {};  // the model has its vertex colours only
  auto repaired = repair(std::move(imported));
  if (!repaired) return tl::unexpected(repaired.error());
  TriangleMesh& mesh = repaired->mesh;
  report.input = {.vertices = mesh.positions.size(),
                  .faces = mesh.faces.size(),
                  .boundary_edges = repaired->boundary_edges,
                  .components = repaired->components,
                  .repairs = std::move(repaired->repairs)};
  order_in_space(mesh);
  report.seconds.read = watch.lap();
  if (progress) progress("read", kRead);

  const int bits = options.bits != 0 ? options.bits : automatic_bits(mesh);
  LatticeMesh fine = quantise(mesh, fit_lattice(mesh.positions, bits));
  mesh.faces = {};
  auto hierarchy = simplify(fine, simplify_options(fine, options, progress), mesh.positions);
  if (!hierarchy) return tl::unexpected(hierarchy.error());
  report.seconds.simplify = watch.lap();

  mesh.faces = std::move(fine.faces);
  fine = {};
  LevelErrors errors(std::move(mesh), *hierarchy, options.threads);
  auto model = encode(std::move(*hierarchy), errors, progress);
  if (!model) return tl::unexpected(model.error());
  report.manifest = std::move(model->manifest);
  report.manifest.unit = unit;
  report.seconds.encode = watch.lap();

  out.file = write_header(report.manifest);
  out.file.insert(out.file.end(), model->body.begin(), model->body.end());
  report.seconds.write = watch.lap();
  if (progress) progress("write", 1.0);
  return out;
}

}  // namespace vitrine::inline codec
