// SPDX-License-Identifier: Apache-2.0
// The meshes on which the benchmarks of the codec run.
#pragma once

#include <filesystem>
#include <vector>

#include "peers.h"
#include "support/product_names.h"

namespace vitrine::bench {

struct BenchmarkModel {
  std::string name;
  Bytes file;
  TriangleMesh clean;
};

// Whether the scan is so large that most views do not need its fine levels. Stricter thresholds
// apply to such a scan.
inline bool is_large(const BenchmarkModel& model) {
  return model.clean.faces.size() >= 1'000'000;
}

Bytes read_file(const std::filesystem::path& path);

// Returns the mesh files in the folder VITRINE_MODELS (default: tests/models) with at most
// `max_faces` triangles, smallest first.
std::vector<BenchmarkModel> read_models(std::size_t max_faces);

}  // namespace vitrine::bench
