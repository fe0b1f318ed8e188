// SPDX-License-Identifier: Apache-2.0
// bench-codec: size against Draco, build time against meshoptimizer, decode time against Draco and
// WebAssembly against native. Exit code 0 only where every ratio keeps its threshold.
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <exception>
#include <fstream>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>
#include <stdexcept>

#include "models.h"
#include "subject.h"

namespace vitrine::bench {
namespace {

constexpr int kBits = 12;
constexpr int kRounds = 5;
constexpr std::size_t kSpeedFaces = 300'000;  // speed is judged on the largest model up to here
constexpr std::size_t kQuickFaces = 50'000;

constexpr double kMaxSize = 1.12;  // geometric mean
constexpr double kMaxBuild = 20;   // times one meshopt_simplify
constexpr double kMaxDecode = 20;  // times Draco's decoder
constexpr double kMaxWasm = 2.5;   // times the native decoder
constexpr double kNoThreshold = std::numeric_limits<double>::infinity();

struct Figure {
  std::string what, key;
  double ours, peer, ratio, threshold;
};

class Report {
 public:
  explicit Report(bool json) : json_(json) {
    if (!json) std::printf("%-34s %14s %14s %8s %8s\n", "", "vitrine", "peer", "ratio", "at most");
  }

  void add(const Figure& f) {
    json_out_[f.what][f.key] = f.ratio;
    within_ = within_ && f.ratio <= f.threshold;
    if (json_) return;
    std::printf("%-34s %14s %14s %8.3f", (f.what + "." + f.key).c_str(), number(f.ours).c_str(),
                number(f.peer).c_str(), f.ratio);
    std::printf(std::isfinite(f.threshold) ? " %8g%s\n" : "\n", f.threshold,
                f.ratio <= f.threshold ? "" : "  too much");
    std::fflush(stdout);
  }

  bool finish() {
    json_out_["within_thresholds"] = within_;
    if (json_) std::puts(json_out_.dump(2).c_str());
    return within_;
  }

 private:
  static std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, value == std::floor(value) ? "%.0f" : "%.5f", value);
    return value == 0 ? "" : text;
  }

  bool json_, within_ = true;
  nlohmann::ordered_json json_out_;
};

// Of processor time: all that is compared runs on one thread, and machines are shared.
double seconds(const std::function<void()>& work) {
  const std::clock_t start = std::clock();
  work();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

struct Medians {
  double ours, peer;
};

// Both take turns, so that a slow moment of the machine falls on both.
Medians interleave(const std::function<double()>& ours, const std::function<double()>& peer) {
  std::vector<double> a, b;
  for (int round = 0; round < kRounds; ++round) {
    a.push_back(ours());
    b.push_back(peer());
  }
  const auto median = [](std::vector<double>& v) {
    std::ranges::nth_element(v, v.begin() + kRounds / 2);
    return v[kRounds / 2];
  };
  return {median(a), median(b)};
}

void compare(Report& report, const char* what, const char* key, const Medians& m, double limit) {
  report.add({what, key, m.ours, m.peer, m.ours / m.peer, limit});
}

void sizes(Report& report, const std::vector<Model>& models) {
  double log_sum = 0;
  for (const Model& model : models) {
    const auto ours = static_cast<double>(build(model.file, kBits).size());
    const auto peer = static_cast<double>(draco_encode(model.clean, kBits).size());
    log_sum += std::log(ours / peer);
    report.add({"size." + model.name, "ratio_to_draco", ours, peer, ours / peer, kNoThreshold});
  }
  const double mean = std::exp(log_sum / static_cast<double>(models.size()));
  report.add({"size.geometric_mean", "ratio_to_draco", 0, 0, mean, kMaxSize});
}

// A file that goes with the object.
class TemporaryFile {
 public:
  explicit TemporaryFile(const Bytes& bytes) {
    const int fd = ::mkstemps(path_, 6);
    if (fd < 0 || ::write(fd, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size()))
      throw std::runtime_error("cannot write a temporary file");
    ::close(fd);
  }
  ~TemporaryFile() { ::unlink(path_); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const char* path() const { return path_; }

 private:
  char path_[40] = "/tmp/bench-codec-XXXXXX.pmesh";
};

// Seconds that the browser's decoder takes in Node for the same file.
double wasm_seconds(const char* pmesh) {
  const std::string command = std::string("node '" VITRINE_SOURCE_DIR
                                          "/tests/bench/codec/decode_wasm.mjs' '" VITRINE_BIN_DIR
                                          "/../wasm/progressive-mesh.wasm' '") +
                              pmesh + "'";
  std::FILE* pipe = ::popen(command.c_str(), "r");
  double value = 0;
  const bool read = pipe != nullptr && std::fscanf(pipe, "%lf", &value) == 1;
  if (pipe == nullptr || ::pclose(pipe) != 0 || !read)
    throw std::runtime_error("the WebAssembly decoder did not run: " + command);
  return value;
}

void speeds(Report& report, const Model& model) {
  const Bytes pmesh = build(model.file, kBits);
  const Bytes draco = draco_encode(model.clean, kBits);
  const MeshoptInput flat = meshopt_input(model.clean);
  const auto faces = model.clean.faces.size();
  if (decode(pmesh) != faces) throw std::runtime_error(model.name + " does not decode whole");

  const auto native = [&] { return seconds([&] { decode(pmesh); }); };
  compare(report, "build", "ratio_to_meshopt_simplify",
          interleave([&] { return seconds([&] { build(model.file, kBits); }); },
                     [&] { return seconds([&] { meshopt_simplify_to_one_percent(flat); }); }),
          kMaxBuild);
  compare(report, "decode", "ratio_to_draco",
          interleave(native, [&] { return seconds([&] { draco_decode(draco); }); }), kMaxDecode);
  const TemporaryFile file(pmesh);
  compare(report, "wasm", "ratio_to_native",
          interleave([&] { return wasm_seconds(file.path()); }, native), kMaxWasm);
}

int run(int argc, char** argv) {
  bool json = false, quick = false;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--json") == 0) {
      json = true;
    } else if (std::strcmp(argv[i], "--quick") == 0) {
      quick = true;
    } else {
      const bool help = std::strcmp(argv[i], "--help") == 0;
      std::fputs(
          "usage: bench-codec [--quick] [--json]   meshes: the folder VITRINE_MODELS\n"
          "--quick: only meshes of at most 50,000 triangles\n",
          help ? stdout : stderr);
      return help ? 0 : 2;
    }
  }
  Report report(json);
  const auto models = read_models(quick ? kQuickFaces : std::numeric_limits<std::size_t>::max());
  sizes(report, models);
  const auto large = std::ranges::find_if(models.rbegin(), models.rend(), [](const Model& model) {
    return model.clean.faces.size() <= kSpeedFaces;
  });
  if (large != models.rend()) speeds(report, *large);
  return report.finish() ? 0 : 1;
}

}  // namespace
}  // namespace vitrine::bench

int main(int argc, char** argv) {
  try {
    return vitrine::bench::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench-codec: %s\n", error.what());
    return 1;
  }
}
