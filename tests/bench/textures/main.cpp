// SPDX-License-Identifier: Apache-2.0
// bench-textures: compares textured models with files of other libraries. The exit code is 0 only
// if every ratio is within its threshold.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <string>

#include "sections.h"
#include "support/product_names.h"

namespace vitrine::bench {
namespace {

int run(int argc, char** argv) {
  const char* folder = std::getenv("VITRINE_MODELS");
  std::string path = folder != nullptr ? folder : VITRINE_SOURCE_DIR "/tests/models";
  bool json = false, is_quick = false;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--json") == 0) {
      json = true;
    } else if (std::strcmp(argv[i], "--quick") == 0) {
      is_quick = true;
    } else if (argv[i][0] != '-') {
      path = argv[i];
    } else {
      const bool help = std::strcmp(argv[i], "--help") == 0;
      std::fputs(
          "Usage: bench-textures [--quick] [--json] [PATH]\n"
          "PATH: a textured model or a folder of them (default: the folder VITRINE_MODELS)\n"
          "--quick: only the sizes of files, without pictures of the models\n",
          help ? stdout : stderr);
      return help ? 0 : 2;
    }
  }
  Report report(json);
  const auto models = read_textured_models(path);
  sizes(report, models);
  for (const TexturedModel& model : models) {
    if (!is_quick) appearance(report, model);
  }
  return report.finish() ? 0 : 1;
}

}  // namespace
}  // namespace vitrine::bench

int main(int argc, char** argv) {
  try {
    return vitrine::bench::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench-textures: %s\n", error.what());
    return 1;
  }
}
