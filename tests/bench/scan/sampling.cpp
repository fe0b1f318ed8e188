// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "accuracy.h"
#include "acquisition/rig_optics/object_file.h"
#include "acquisition/surface/surface_of.h"
#include "cast_profiles.h"
#include "codec/export/write_mesh.h"
#include "picture.h"
#include "sections.h"
#include "support/product_names.h"
#include "value_of.h"

namespace vitrine::bench {
namespace {

constexpr int kLengths[] = {5, 10, 15, 20};
constexpr double kRow = 0.1;     // distance in mm between the points of a profile at the rig
constexpr double kNoise = 0.03;  // standard deviation in mm of a stripe point at the rig

// [WLL] table 1: number of vertices after sampling divided by the number before, at L = 5.
constexpr double kPaperSkull = 0.2046, kPaperHead = 0.2012;

struct Sampled {
  TriangleMesh mesh;
  std::uint64_t points = 0;
};

class Sampler {
 public:
  Sampler(std::vector<Profile> profiles, double noise)
      : profiles_(std::move(profiles)), noise_(noise) {}

  Sampled by(SamplingMethod method, int length) const {
    SurfaceOptions options;
    options.noise = noise_;
    options.sampling = {method, length};  // the points are smoothed first, as in a scan
    auto surface = value_of(surface_of(profiles_, options));
    return {std::move(surface.mesh), surface.report.sampled};
  }

 private:
  std::vector<Profile> profiles_;
  double noise_;
};

double kilobytes(const TriangleMesh& mesh) {
  return static_cast<double>(value_of(write_mesh(mesh, MeshFormat::kVrml, {.unit = "mm"})).size()) /
         1024;
}

void table_row(Report& report, const std::string& what, const Sampled& all, const Sampled& few) {
  const auto add = [&](const char* key, double after, double before) {
    report.add({what, key, after, before, after / before, kNoThreshold});
  };
  add("vertices_ratio_to_all", static_cast<double>(few.mesh.positions.size()),
      static_cast<double>(all.mesh.positions.size()));
  add("polygons_ratio_to_all", static_cast<double>(few.mesh.faces.size()),
      static_cast<double>(all.mesh.faces.size()));
  add("vrml_kb_ratio_to_all", kilobytes(few.mesh), kilobytes(all.mesh));
}

// Returns the larger of two rms distances: from the mesh to the object, and from `all` to the mesh.
// `all` is the mesh of all measured points.
double error_of(const TriangleMesh& mesh, const TriangleMesh& object, const TriangleMesh& all) {
  return std::max(distances(mesh, object).rms, distances(all, mesh).rms);
}

double vertices_of(const Sampled& sampled) {
  return static_cast<double>(sampled.mesh.positions.size());
}

// Returns the error of adaptive sampling at the given number of vertices. Tries decreasing sampling
// lengths, starting at `length`. Interpolates on a log-log scale between the lengths that give
// fewer and more vertices. If `length` gives enough vertices already, returns the error at
// `length`.
template <class Error>
double error_at(double vertices, int length, const Sampler& sampler, const Error& error) {
  Sampled few = sampler.by(SamplingMethod::kAdaptive, length);
  while (--length > 0 && vertices_of(few) < vertices) {
    Sampled more = sampler.by(SamplingMethod::kAdaptive, length);
    if (vertices_of(more) >= vertices) {
      const double part =
          std::log(vertices / vertices_of(few)) / std::log(vertices_of(more) / vertices_of(few));
      return std::pow(error(few.mesh), 1 - part) * std::pow(error(more.mesh), part);
    }
    few = std::move(more);
  }
  return error(few.mesh);
}

// Compares adaptive sampling with the sampling of [WLL] on profiles of one object. `noisy` states
// whether the profiles have noise.
void judge_errors(Report& report, const std::string& what, const Sampler& sampler,
                  const TriangleMesh& object, const TriangleMesh& all, bool noisy) {
  const auto error = [&](const TriangleMesh& mesh) { return error_of(mesh, object, all); };
  for (const int length : kLengths) {
    const Sampled paper = sampler.by(SamplingMethod::kPaper, length);
    const Sampled adaptive = sampler.by(SamplingMethod::kAdaptive, length);
    const std::string row = fmt::format("{}.{}.L{}", what, noisy ? "noise" : "clean", length);
    const auto ratio = [&](const char* key, double ours, double peer, double limit) {
      report.add({row, key, ours, peer, ours / peer, limit});
    };
    constexpr double kEqual = 1.01, kHalf = 0.5, kNoWorse = 1, kLong = 15;
    ratio("vertices_ratio_to_paper", vertices_of(adaptive), vertices_of(paper), kEqual);
    ratio("rms_at_equal_vertices_ratio_to_paper",
          error_at(vertices_of(paper), length, sampler, error), error(paper.mesh),
          noisy             ? kNoWorse
          : length >= kLong ? kHalf
                            : kNoThreshold);
  }
}

void table_one(Report& report, const Options& options, const Sampler& sampler,
               const std::string& object, double paper_at_5) {
  const Sampled all = sampler.by(SamplingMethod::kEquidistant, 1);
  constexpr std::pair<SamplingMethod, const char*> kMethods[] = {
      {SamplingMethod::kEquidistant, "equidistant"},
      {SamplingMethod::kPaper, "paper"},
      {SamplingMethod::kAdaptive, "adaptive"}};
  show(options, fmt::format("figure-6-{}-all", object), all.mesh);
  for (const auto& [method, name] : kMethods) {
    for (const int length : kLengths) {
      const Sampled few = sampler.by(method, length);
      const std::string what = fmt::format("table_1.{}.{}.L{}", object, name, length);
      table_row(report, what, all, few);
      show(options, fmt::format("figure-9-{}-{}-L{}", object, name, length), few.mesh);
      if (method != SamplingMethod::kPaper || length != 5) continue;
      const double ratio = static_cast<double>(few.points) / static_cast<double>(all.points);
      report.add({what, "points_ratio_to_the_papers", ratio, paper_at_5, ratio / paper_at_5,
                  kNoThreshold});
    }
  }
}

}  // namespace

void sampling(Report& report, const Options& options, const Object& object) {
  const TriangleMesh mesh = value_of(rig::load({.file = object.file}));
  const int steps = options.is_quick ? 90 : 720;
  std::vector<Profile> profiles = cast_profiles(mesh, steps, kRow);
  const Sampler clean(profiles, 0);
  add_noise(profiles, kNoise);
  const Sampler noisy(std::move(profiles), kNoise);
  table_one(report, options, noisy, object.name, object.name == "skull" ? kPaperSkull : kPaperHead);
  const TriangleMesh all = clean.by(SamplingMethod::kEquidistant, 1).mesh;
  const std::string what = "sampling." + object.name;
  judge_errors(report, what, clean, mesh, all, false);
  judge_errors(report, what, noisy, mesh, all, true);
}

}  // namespace vitrine::bench
