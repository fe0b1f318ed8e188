// SPDX-License-Identifier: Apache-2.0
#include "report.h"
#include "support/product_names.h"

#include <cmath>
#include <cstdio>

namespace vitrine::bench {
namespace {

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, value == std::floor(value) ? "%.0f" : "%.5f", value);
  return value == 0 ? "" : text;
}

}  // namespace

Report::Report(bool json) : json_(json) {
  if (!json) std::printf("%-44s %12s %12s %8s %8s\n", "", "vitrine", "peer", "ratio", "limit");
}

void Report::add(const Figure& f) {
  json_out_[f.what][f.key] = f.ratio;
  within_ = within_ && f.is_within();
  ++figures_;
  judged_ += std::isfinite(f.threshold) ? 1 : 0;
  if (json_) return;
  std::printf("%-44s %12s %12s %8.3f", (f.what + "." + f.key).c_str(), number(f.ours).c_str(),
              number(f.peer).c_str(), f.ratio);
  if (std::isfinite(f.threshold)) {
    const char* verdict = f.is_within() ? "" : f.is_minimum ? "  too little" : "  too much";
    std::printf(" %s %5g%s", f.is_minimum ? ">=" : "<=", f.threshold, verdict);
  }
  std::printf("\n");
  std::fflush(stdout);
}

bool Report::finish() {
  json_out_["within_thresholds"] = within_;
  if (json_) {
    std::puts(json_out_.dump(2).c_str());
  } else {
    std::printf(
        "%zu of %zu figures have a limit here; more and larger scans in VITRINE_MODELS are "
        "held to more\n",
        judged_, figures_);
  }
  return within_;
}

}  // namespace vitrine::bench
