// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/build_model.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <future>
#include <memory>

#include "codec/base/model_encoder.h"
#include "codec/import/repair.h"
#include "codec/progressive/display_filter.h"
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

// Measures levels, `threads` at a time, while the next ones are being coded.
class LevelErrors {
 public:
  // `fine` is `original` rounded to the lattice.
  LevelErrors(const TriangleMesh& original, const LatticeMesh& fine, unsigned threads)
      : meter_(original), fine_(fine), lattice_(fine.lattice), threads_(threads) {}

  // `last`: full resolution is shown as it is, which is `fine`.
  void add(const MeshState& level, bool last) {
    while (pending_.size() + 1 >= threads_ && !pending_.empty())
      settle();
    double filter = last ? 0 : fit_display_filter(level, lattice_, meter_.original());
    filter = static_cast<float>(filter);  // as the header stores it
    filters_.push_back(filter);
    const auto how = threads_ > 1 ? std::launch::async : std::launch::deferred;
    if (last) {
      pending_.push_back(std::async(how, [this] { return meter_.measure_moved(to_model(fine_)); }));
    } else {
      pending_.push_back(std::async(
          how, [this, mesh = displayed(level, filter)] { return meter_.measure(*mesh); }));
    }
  }

  // Waits for all levels and enters what they showed.
  void finish(Manifest& manifest) {
    while (!pending_.empty())
      settle();
    for (std::size_t i = 0; i < manifest.levels.size(); ++i) {
      manifest.levels[i].display_filter = filters_[i];
      manifest.levels[i].max_error = errors_[i].max_error;
      manifest.levels[i].rms_error = errors_[i].rms_error;
    }
  }

 private:
  std::shared_ptr<const TriangleMesh> displayed(const MeshState& level, double filter) const {
    auto mesh = std::make_shared<TriangleMesh>();
    const LevelInfo shown{.display_filter = filter, .shift = level.shift};
    filter_for_display(
        level, [&](VertexId) -> const LevelInfo& { return shown; }, mesh->positions);
    for (Vec3& p : mesh->positions)
      p = lattice_.origin + p * lattice_.step;
    mesh->faces = level.real_faces();
    return mesh;
  }

  void settle() {
    errors_.push_back(pending_.front().get());
    pending_.pop_front();
  }

  ErrorMeter meter_;
  const LatticeMesh& fine_;
  Lattice lattice_;
  unsigned threads_;
  std::deque<std::future<LevelError>> pending_;
  std::vector<double> filters_;     // per level
  std::vector<LevelError> errors_;  // per settled level
};

SimplifyOptions simplify_options(const LatticeMesh& fine, const BuildOptions& options,
                                 const BuildProgress& progress) {
  SimplifyOptions how{.placement = options.placement,
                      .order = options.order,
                      .regions = region_count(fine.positions.size())};
  if (progress) how.progress = [&](double done) { progress("simplify", 0.1 + 0.4 * done); };
  return how;
}

Expected<EncodedModel> encode(Hierarchy hierarchy, const LatticeMesh& fine, LevelErrors& errors,
                              const BuildProgress& progress) {
  const std::size_t levels = hierarchy.levels.size();
  std::size_t level = 0;
  auto model = encode_model(std::move(hierarchy), fine, [&](const MeshState& mesh) {
    errors.add(mesh, level == levels);
    if (level++ == 0 || !progress) return;
    const double share =
        static_cast<double>(mesh.vertex_count()) / static_cast<double>(fine.positions.size());
    progress("encode", 0.5 + 0.4 * share);
  });
  if (model) errors.finish(model->manifest);
  return model;
}

// A mapped file need not stay in memory once it is read; harmless for memory of any other kind.
void let_go(std::span<const std::uint8_t> input) {
  const auto page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
  const auto begin = reinterpret_cast<std::uintptr_t>(input.data()) / page * page;
  const auto end = reinterpret_cast<std::uintptr_t>(input.data() + input.size());
  ::madvise(reinterpret_cast<void*>(begin), end - begin, MADV_PAGEOUT);
}

}  // namespace

Expected<BuildResult> build_model(std::span<const std::uint8_t> input, const BuildOptions& options,
                                  const BuildProgress& progress) {
  Stopwatch watch;
  BuildResult out;
  BuildReport& report = out.report;
  auto imported = read_mesh(input, options.reading);
  if (!imported) return tl::unexpected(imported.error());
  let_go(input);
  const std::string unit = imported->unit;
  auto repaired = repair(std::move(*imported));
  if (!repaired) return tl::unexpected(repaired.error());
  TriangleMesh& mesh = repaired->mesh;
  report.input = {.vertices = mesh.positions.size(),
                  .faces = mesh.faces.size(),
                  .boundary_edges = repaired->boundary_edges,
                  .components = repaired->components,
                  .repairs = std::move(repaired->repairs)};
  report.seconds.read = watch.lap();
  if (progress) progress("read", 0.1);

  const int bits = options.bits != 0 ? options.bits : automatic_bits(mesh);
  const LatticeMesh fine = quantise(mesh, fit_lattice(mesh.positions, bits));
  auto hierarchy = simplify(fine, simplify_options(fine, options, progress));
  if (!hierarchy) return tl::unexpected(hierarchy.error());
  report.seconds.simplify = watch.lap();

  LevelErrors errors(mesh, fine, options.threads);
  mesh = {};  // the error bounds have their own copy
  auto model = encode(std::move(*hierarchy), fine, errors, progress);
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

}  // namespace vitrine
