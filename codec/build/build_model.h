// SPDX-License-Identifier: Apache-2.0
// Builds the bytes of a `.pmesh` from the bytes of a mesh file: reads, repairs, quantises,
// simplifies, encodes and measures the mesh. Accesses no files and starts no processes, so it can
// run in a sandboxed child process.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "codec/core/expected.h"
#include "codec/core/progress.h"
#include "codec/format/manifest.h"
#include "codec/import/read_mesh.h"
#include "codec/simplify/simplify.h"

namespace vitrine::inline codec {

// Default size of a region, in vertices. In each level, slightly less than half of the vertices are
// new. Each new vertex takes one to two bytes in the finest level. A chunk of the finest level
// therefore has 10 to 30 KB.
inline constexpr std::uint32_t kRegionVertices = 30'000;

struct BuildOptions {
  ReadOptions reading = {};
  // Bits per coordinate, from kMinBits to kMaxBits. 0 chooses the number from the median edge
  // length.
  int bits = 0;
  Placement placement = Placement::kMidpoint;
  CollapseOrder order = CollapseOrder::kBatch;
  // Target size of a region (SimplifyOptions). A model with at most twice this many vertices gets
  // only one region.
  std::uint32_t region_vertices = kRegionVertices;
  unsigned threads = 1;  // at least 1; does not change the output
};

struct BuildReport {
  struct Input {
    std::uint64_t vertices = 0, faces = 0;  // counts after repair
    std::uint64_t boundary_edges = 0, components = 0;
    std::vector<std::string> repairs;
  };
  struct Seconds {
    // durations in seconds; `encode` includes the computation of error bounds
    double read = 0, simplify = 0, encode = 0, write = 0;
  };

  Input input;
  Manifest manifest;  // manifest of the finished file
  Seconds seconds;
};

struct BuildResult {
  std::vector<std::uint8_t> file;
  BuildReport report;
};

// Builds a model from the bytes of a mesh file. `progress` receives the stages "read", "simplify",
// "encode" and "write". Fails with the error of read_mesh() or repair() (kBadInput, kUnsupported or
// kLimit).
Expected<BuildResult> build_model(std::span<const std::uint8_t> input, const BuildOptions& options,
                                  const ProgressReport& progress = {});

// Builds a model from a mesh in memory. Ignores `options.reading`.
Expected<BuildResult> build_model(ImportedMesh imported, const BuildOptions& options,
                                  const ProgressReport& progress = {});

}  // namespace vitrine::inline codec
