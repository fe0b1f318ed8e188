// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "peers.h"

namespace vitrine::bench {

struct Model {
  std::string name;
  Bytes file;
  TriangleMesh clean;
};

// From here on a scan is held to more: its fine levels are finer than what most views ask for.
inline bool is_large(const Model& model) {
  return model.clean.faces.size() >= 1'000'000;
}

Bytes read_file(const std::filesystem::path& path);

// The mesh files of the folder VITRINE_MODELS (default: the ones that ship) with at most
// `max_faces` triangles, smallest first.
std::vector<Model> read_models(std::size_t max_faces);

}  // namespace vitrine::bench
