// SPDX-License-Identifier: Apache-2.0
// bench-codec: compares size, rate-distortion, build time and decode time with other libraries. The
// exit code is 0 only if every ratio is within its threshold.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <exception>
#include <limits>

#include "sections.h"
#include "support/product_names.h"

namespace vitrine::bench {
namespace {

// Maximum number of faces of the model that the speed sections use.
constexpr std::size_t kSpeedFaces = 300'000;
constexpr std::size_t kQuickFaces = 50'000;

int run(int argc, char** argv) {
  bool json = false, is_quick = false;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--json") == 0) {
      json = true;
    } else if (std::strcmp(argv[i], "--quick") == 0) {
      is_quick = true;
    } else {
      const bool help = std::strcmp(argv[i], "--help") == 0;
      std::fputs(
          "Usage: bench-codec [--quick] [--json]   meshes: the folder VITRINE_MODELS\n"
          "--quick: only meshes of at most 50,000 triangles\n",
          help ? stdout : stderr);
      return help ? 0 : 2;
    }
  }
  Report report(json);
  const auto models = read_models(is_quick ? kQuickFaces : std::numeric_limits<std::size_t>::max());
  sizes(report, models);
  rate_distortion(report, models);
  for (const BenchmarkModel& model : models)
    regions(report, model);
  const auto large = std::ranges::find_if(
      models.rbegin(), models.rend(),
      [](const BenchmarkModel& model) { return model.clean.faces.size() <= kSpeedFaces; });
  if (large != models.rend()) {
    simplifiers(report, *large);
    speeds(report, *large);
    builds(report, *large, models.back());
  }
  variants(report, models[models.size() / 2]);
  return report.finish() ? 0 : 1;
}

}  // namespace
}  // namespace vitrine::bench

int main(int argc, char** argv) {
  try {
    return vitrine::bench::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench-codec: %s\n", error.what());
    return 1;
  }
}
