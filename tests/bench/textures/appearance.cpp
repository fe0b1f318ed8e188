// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdio>
#include <limits>
#include <string>

#include "discrete_ladder.h"
#include "sections.h"
#include "streamed_model.h"
#include "support/product_names.h"

namespace vitrine::bench {
namespace {

// Structural similarities to the source. For each one, the benchmark compares the bytes that are
// needed to reach it.
constexpr std::array<double, 3> kTargets = {0.90, 0.95, 0.98};
// Largest accepted ratio of our bytes to those of the best separate file.
constexpr double kMaxSingle = 1.15;
// Largest accepted ratio of our bytes to those of a client that fetches every rung of the ladder
// (discrete_ladder.h).
constexpr double kMaxClient = 0.7;
constexpr double kLeastFinest = 0.99;  // least structural similarity of the finest state

// Returns the bytes of a state, or infinity if there is no state.
double bytes_of(const std::optional<ModelState>& state, const StateBytes& bytes) {
  return state ? bytes.of(*state) : std::numeric_limits<double>::infinity();
}

struct Compared {
  StreamedModel stream;
  DiscreteLadder ladder;
  StateGrid ours, peers;
};

void compare_at(Report& report, const std::string& name, double ssim, Compared& compared) {
  auto& [stream, ladder, ours, peers] = compared;
  const StateBytes bytes = stream.bytes(), single = ladder.single_files(),
                   client = ladder.one_after_the_other();
  const auto best = ours.cheapest(ssim, bytes);
  const double own = bytes_of(best, bytes), file = bytes_of(peers.cheapest(ssim, single), single),
               sum = bytes_of(peers.cheapest(ssim, client), client),
               viewer = bytes_of(ours.first(ssim, stream.viewer_path()), bytes);
  char what[64];
  std::snprintf(what, sizeof what, "bytes.%s.ssim_%.2f", name.c_str(), ssim);
  report.add({what, "ratio_to_single_file", own, file, own / file, kMaxSingle});
  report.add({what, "ratio_to_each_rung", own, sum, own / sum, kMaxClient});
  report.add({what, "viewer_ratio_to_single_file", viewer, file, viewer / file, kNoThreshold});
  if (!best) return;
  const double pictures = bytes.pictures[best->pictures];
  report.add({what, "share_of_later_pictures", pictures, own, pictures / own, kNoThreshold});
}

}  // namespace

void appearance(Report& report, const TexturedModel& model) {
  const AppearanceReference reference = model.reference();
  BuildResult built = model.build(0);
  const int bits = built.report.manifest.lattice.bits;
  Compared compared{.stream = StreamedModel(std::move(built.file)),
                    .ladder = DiscreteLadder(model, bits),
                    .ours = StateGrid([&](const ModelState& state) {
                      return compared.stream.ssim(reference, state);
                    }),
                    .peers = StateGrid([&](const ModelState& state) {
                      return compared.ladder.ssim(reference, state);
                    })};
  const double finest = compared.ours.ssim(compared.stream.finest());
  report.add({"appearance." + model.name, "ssim_of_finest", finest, 1, finest, kLeastFinest, true});
  for (const double ssim : kTargets)
    compare_at(report, model.name, ssim, compared);
}

}  // namespace vitrine::bench
