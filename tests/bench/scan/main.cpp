// SPDX-License-Identifier: Apache-2.0
// bench-scan: measures accuracy, sampling, simplification and speed of scans at the simulated rig.
// The exit code is 0 only if every measured value is within its limit.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <set>
#include <stdexcept>

#include "sections.h"
#include "support/product_names.h"

namespace vitrine::bench {
namespace {

namespace fs = std::filesystem;

constexpr const char* kUsage =
    "Usage: bench-scan [--quick] [--json] [--pictures DIR] [--only SECTION]...\n"
    "meshes: the folder VITRINE_MODELS; sections: ground_truth, error_table, sampling,\n"
    "simplification, speed\n"
    "--quick: few steps and one object per section; accuracy is not judged\n";

struct CommandLine {
  bool json = false, help = false;
  Options options;
  std::set<std::string> only;  // the sections to run; empty: all
  fs::path bare_camera, emergency_stops;
  int steps = 0;

  bool wants(const char* section) const { return only.empty() || only.contains(section); }
};

bool parse(int argc, char** argv, CommandLine& line) {
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const int left = argc - i - 1;
    if (word == "--json") {
      line.json = true;
    } else if (word == "--quick") {
      line.options.is_quick = true;
    } else if (word == "--help") {
      line.help = true;
    } else if (word == "--pictures" && left >= 1) {
      line.options.pictures = argv[++i];
    } else if (word == "--only" && left >= 1) {
      line.only.insert(argv[++i]);
    } else if (word == "--emergency-stops" && left >= 1) {
      line.emergency_stops = argv[++i];
    } else if (word == "--bare-camera" && left >= 2) {
      line.bare_camera = argv[++i];
      line.steps = std::atoi(argv[++i]);
    } else {
      return false;
    }
  }
  return true;
}

bool run_sections(const CommandLine& line) {
  Report report(line.json);
  const Options& options = line.options;
  const std::vector<Object> all = objects();
  const Object &skull = object_of(all, "skull"), &head = object_of(all, "igea");
  if (line.wants("ground_truth")) ground_truth(report, options, all);
  if (line.wants("error_table")) error_table(report, options, head);
  if (line.wants("sampling")) {
    sampling(report, options, head);
    if (!options.is_quick) sampling(report, options, skull);
  }
  if (line.wants("simplification")) simplification(report, options, skull, head);
  if (line.wants("speed")) speed(report, options, head);
  return report.finish();
}

int run(int argc, char** argv) {
  CommandLine line;
  if (!parse(argc, argv, line) || line.help) {
    std::fputs(kUsage, line.help ? stdout : stderr);
    return line.help ? 0 : 2;
  }
  if (!line.bare_camera.empty()) return run_bare_camera(line.bare_camera, line.steps);
  if (!line.emergency_stops.empty()) return run_emergency_stops(line.emergency_stops);
  return run_sections(line) ? 0 : 1;
}

}  // namespace

std::vector<Object> objects() {
  const char* set = std::getenv("VITRINE_MODELS");
  const fs::path folder = set ? set : VITRINE_SOURCE_DIR "/tests/models";
  std::vector<Object> found;
  for (const char* file : {"demosthenes.obj", "skull.obj", "igea.ply", "bunny.ply"}) {
    if (fs::exists(folder / file)) found.push_back({fs::path(file).stem().string(), folder / file});
  }
  if (found.empty())
    throw std::runtime_error(folder.string() + ": none of the objects; set VITRINE_MODELS");
  return found;
}

const Object& object_of(const std::vector<Object>& all, const std::string& name) {
  const auto it = std::ranges::find(all, name, &Object::name);
  return it == all.end() ? all.front() : *it;
}

}  // namespace vitrine::bench

int main(int argc, char** argv) {
  try {
    return vitrine::bench::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench-scan: %s\n", error.what());
    return 1;
  }
}
