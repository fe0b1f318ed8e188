// SPDX-License-Identifier: Apache-2.0
#include "models.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <set>
#include <stdexcept>

#include "subject.h"
#include "support/product_names.h"

namespace vitrine::bench {

namespace fs = std::filesystem;

Bytes read_file(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + path.string());
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<BenchmarkModel> read_models(std::size_t max_faces) {
  const char* folder = std::getenv("VITRINE_MODELS");
  const std::set<std::string> meshes = {".ply", ".obj", ".stl", ".off", ".glb"};
  if (folder && !fs::is_directory(folder))
    throw std::runtime_error(std::string("VITRINE_MODELS: there is no folder ") + folder);
  std::vector<BenchmarkModel> models;
  for (const auto& entry :
       fs::directory_iterator(folder ? folder : VITRINE_SOURCE_DIR "/tests/models")) {
    if (entry.path().extension() == ".xz") {
      std::fprintf(stderr, "bench-codec: %s is left out; unpack it with xz -d\n",
                   entry.path().filename().c_str());
    }
    if (!meshes.contains(entry.path().extension().string())) continue;
    BenchmarkModel model{entry.path().stem().string(), read_file(entry.path()), {}};
    model.clean = read_clean(model.file);
    if (model.clean.faces.size() <= max_faces) models.push_back(std::move(model));
  }
  if (models.empty()) throw std::runtime_error("no mesh file in the folder VITRINE_MODELS");
  std::ranges::sort(models, {},
                    [](const BenchmarkModel& model) { return model.clean.faces.size(); });
  return models;
}

}  // namespace vitrine::bench
