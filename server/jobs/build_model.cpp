// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/build_model.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <future>

#include "codec/base/model_encoder.h"
#include "codec/import/repair.h"
#include "codec/progressive/display_filter.h"
#include "codec/simplify/display_fit.h"
#include "codec/simplify/error_meter.h"
#include "codec/simplify/order_in_space.h"
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

// Measures levels, `threads` at a time, while the next ones are being coded.
class LevelErrors {
 public:
  LevelErrors(TriangleMesh original, const Hierarchy& hierarchy, unsigned threads)
      : meter_(std::move(original)),
        lattice_(hierarchy.base.lattice),
        tree_(hierarchy.tree),
        leaf_(hierarchy.leaf),
        threads_(threads) {}

  // `last`: full resolution is shown as it is, the original rounded to the lattice.
  void add(const MeshState& level, bool last) {
    const std::size_t weight = make_room(last ? 0 : level.connectivity.face_count());
    double filter = last ? 0 : fit_display_filter(level, lattice_, meter_.original());
    filter = static_cast<float>(filter);  // as the header stores it
    filters_.push_back(filter);
    const auto how = threads_ > 1 ? std::launch::async : std::launch::deferred;
    if (last) {
      const auto measure = [this, regions = regions_of({})] {
        return meter_.measure_moved(
            [this](const Vec3& p) { return lattice_.to_model(lattice_.to_lattice(p)); }, regions);
      };
      pending_.push_back({std::async(how, measure), weight});
    } else {
      auto measure = [this, mesh = displayed(level, filter),
                      regions = regions_of(leaves_of(level))]() mutable {
        return meter_.measure(std::move(mesh), regions);
      };
      pending_.push_back({std::async(how, std::move(measure)), weight});
    }
    if (threads_ == 1) settle();
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
    std::vector<std::size_t> entered(errors_.size());
    for (ChunkInfo& chunk : manifest.chunks)
      chunk.max_error = errors_[chunk.level].region_errors[entered[chunk.level]++];
    for (ChunkInfo& chunk : manifest.chunks)
      allow_for_finer_neighbours(chunk, manifest);
  }

 private:
  // A face between a region and one that is a level finer is in the mesh of one of the levels, but
  // for its own corners' low bits, which come with the region's next chunk.
  static void allow_for_finer_neighbours(ChunkInfo& chunk, const Manifest& manifest) {
    const std::uint32_t finer = chunk.level + 1;
    if (finer >= manifest.levels.size() || manifest.tree.regions_at(finer).size() == 1) return;
    const std::int32_t cells =
        (1 << manifest.levels[chunk.level].shift) - (1 << manifest.levels[finer].shift);
    const RegionNode& region = manifest.region(chunk);
    for (std::uint32_t leaf = region.first; leaf < region.first + region.leaves; ++leaf) {
      const ChunkInfo& next = manifest.chunks[manifest.find_chunk(finer, leaf)];
      chunk.max_error = std::max(chunk.max_error, next.max_error);
    }
    chunk.max_error += std::sqrt(0.75) * cells * manifest.lattice.step;
  }

  // Returns what a level of so many faces weighs. Levels that are measured at the same time take
  // about as much memory as the original does.
  std::size_t make_room(std::size_t faces) {
    const std::size_t original = meter_.original().size(), weight = faces + original / kAtOnce;
    while (!pending_.empty() && (pending_.size() + 1 >= threads_ || weight_ + weight > original))
      settle();
    weight_ += weight;
    return weight;
  }

  TriangleMesh displayed(const MeshState& level, double filter) const {
    TriangleMesh mesh;
    const LevelInfo shown{.display_filter = filter, .shift = level.shift};
    mesh.positions.reserve(level.vertex_count());
    for (VertexId v = 0; v < level.vertex_count(); ++v)
      mesh.positions.push_back(lattice_.origin + display_position(level, v, shown) * lattice_.step);
    mesh.faces = level.real_faces();
    return mesh;
  }

  // The number of the region of the level at hand that holds a leaf, per leaf.
  std::vector<std::uint16_t> number_regions(std::uint32_t& count) const {
    std::vector<std::uint16_t> of_leaf(tree_.leaves());
    for (const std::uint32_t node :
         tree_.regions_at(static_cast<std::uint32_t>(filters_.size() - 1))) {
      const RegionNode& region = tree_.nodes[node];
      std::fill_n(of_leaf.begin() + region.first, region.leaves,
                  static_cast<std::uint16_t>(count++));
    }
    return of_leaf;
  }

  static std::vector<std::uint16_t> leaves_of(const MeshState& level) {
    std::vector<std::uint16_t> leaves;
    leaves.reserve(level.vertex_count());
    for (VertexId v = 0; v < level.vertex_count(); ++v)
      leaves.push_back(level.vertex[v].region);
    return leaves;
  }

  // `leaves` is per vertex of the level.
  LevelRegions regions_of(std::vector<std::uint16_t> leaves) const {
    LevelRegions out{.of_level = std::move(leaves), .of_original = leaf_, .count = 0};
    const auto of_leaf = number_regions(out.count);
    if (out.count == 1) return {};
    for (auto* regions : {&out.of_level, &out.of_original}) {
      for (std::uint16_t& region : *regions)
        region = of_leaf[region];
    }
    return out;
  }

  void settle() {
    errors_.push_back(pending_.front().error.get());
    weight_ -= pending_.front().weight;
    pending_.pop_front();
  }

  static constexpr std::size_t kAtOnce = 8;  // levels at most

  struct Pending {
    std::future<LevelError> error;
    std::size_t weight;
  };

  ErrorMeter meter_;
  Lattice lattice_;
  RegionTree tree_;
  std::vector<std::uint16_t> leaf_;  // per vertex of the original
  unsigned threads_;
  std::deque<Pending> pending_;
  std::size_t weight_ = 0;          // of all pending
  std::vector<double> filters_;     // per level
  std::vector<LevelError> errors_;  // per settled level
};

// Shares of a build's time, as measured: the time left is told by them.
constexpr double kRead = 0.02, kSimplified = 0.3, kEncoded = 0.99;
constexpr double kPerLevel = 0.27;  // of coding and measuring: the same for each level

SimplifyOptions simplify_options(const LatticeMesh& fine, const BuildOptions& options,
                                 const BuildProgress& progress) {
  // Two regions would spare a camera little, and have their price all the same.
  const bool few = fine.positions.size() <= 2 * std::size_t{options.region_vertices};
  SimplifyOptions how{.placement = options.placement,
                      .order = options.order,
                      .region_vertices = few ? 0 : options.region_vertices};
  if (progress)
    how.progress = [&](double done) { progress("simplify", std::lerp(kRead, kSimplified, done)); };
  return how;
}

Expected<EncodedModel> encode(Hierarchy hierarchy, LevelErrors& errors,
                              const BuildProgress& progress) {
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
  order_in_space(mesh);
  report.seconds.read = watch.lap();
  if (progress) progress("read", kRead);

  const int bits = options.bits != 0 ? options.bits : automatic_bits(mesh);
  LatticeMesh fine = quantise(mesh, fit_lattice(mesh.positions, bits));
  mesh.faces = {};
  auto hierarchy = simplify(fine, simplify_options(fine, options, progress));
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

}  // namespace vitrine
