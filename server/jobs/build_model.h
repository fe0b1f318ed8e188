// SPDX-License-Identifier: Apache-2.0
// From the bytes of a mesh file to the bytes of a `.pmesh`: read, repair, quantise, simplify, code,
// measure. Runs in one process without files, so that it fits into the sandboxed child.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "codec/core/expected.h"
#include "codec/import/read_mesh.h"
#include "codec/progressive/manifest.h"
#include "codec/simplify/simplify.h"

namespace vitrine {

// A level comes with somewhat less than half of its vertices, at one to two bytes each at the
// finest: this makes chunks of some 10 to 30 KB.
inline constexpr std::uint32_t kRegionVertices = 30'000;

struct BuildOptions {
  ReadOptions reading = {};
  int bits = 0;  // kMinBits..kMaxBits; 0: the fewest whose step is at most 1/32 of the median edge
  Placement placement = Placement::kMidpoint;
  CollapseOrder order = CollapseOrder::kBatch;
  // See SimplifyOptions; a model of at most twice as many vertices is one region.
  std::uint32_t region_vertices = kRegionVertices;
  unsigned threads = 1;  // >= 1; the output does not depend on it
};

struct BuildReport {
  struct Input {
    std::uint64_t vertices = 0, faces = 0;  // after repair
    std::uint64_t boundary_edges = 0, components = 0;
    std::vector<std::string> repairs;
  };
  struct Seconds {
    double read = 0, simplify = 0, encode = 0, write = 0;  // encode includes the error bounds
  };

  Input input;
  Manifest manifest;  // of the finished file
  Seconds seconds;
};

struct BuildResult {
  std::vector<std::uint8_t> file;
  BuildReport report;
};

// Called from the building thread with a stage ("read", "simplify", "encode", "write") and the
// fraction of the whole that is done, 0..1.
using BuildProgress = std::function<void(std::string_view stage, double done)>;

// Fails (kBadInput, kUnsupported, kLimit) with the reader's or the repair's own message.
Expected<BuildResult> build_model(std::span<const std::uint8_t> input, const BuildOptions& options,
                                  const BuildProgress& progress);

}  // namespace vitrine
