// SPDX-License-Identifier: Apache-2.0
#include "scans.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <stdexcept>

#include "codec/build/build_model.h"
#include "support/product_names.h"

namespace vitrine::bench {
namespace {

namespace fs = std::filesystem;

std::vector<std::uint8_t> read(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

Scan load(const std::string& name) {
  const char* const set = std::getenv("VITRINE_MODELS");
  const fs::path folder = set != nullptr ? set : VITRINE_SOURCE_DIR "/tests/models";
  for (const char* const extension : {".pmesh", ".ply", ".obj"}) {
    const fs::path file = folder / (name + extension);
    if (!fs::exists(file)) continue;
    Scan scan{name, {.manifest = {}, .bytes = read(file)}};
    if (file.extension() != ".pmesh") {
      auto built = build_model(scan.pmesh.bytes, {}, [](std::string_view, double) {});
      scan.pmesh.bytes = std::move(built.value().file);
    }
    scan.pmesh.manifest = parse_header(scan.pmesh.bytes).value();
    return scan;
  }
  throw std::runtime_error(folder.string() + " holds no " + name +
                           "; name a folder that does in VITRINE_MODELS, or look with --quick");
}

}  // namespace

const Scan& scan(const std::string& name) {
  static std::map<std::string, Scan> scans;
  const auto found = scans.find(name);
  return found != scans.end() ? found->second : scans.emplace(name, load(name)).first->second;
}

}  // namespace vitrine::bench
