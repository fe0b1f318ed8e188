// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdio>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>

#include "processor_time.h"
#include "sections.h"
#include "subject.h"
#include "support/product_names.h"
#include "temporary_file.h"

namespace vitrine::bench {
namespace {

constexpr int kRounds = 5;
// Limits apply only to scans of at least this size. For smaller scans, fixed costs outweigh the
// cost per triangle.
constexpr std::size_t kJudgedVertices = 100'000;
constexpr double kMaxBuild = 20;       // maximum build time, as a multiple of one meshopt_simplify
constexpr double kMaxLargeBuild = 15;  // replaces kMaxBuild for scans of at least a million faces
constexpr double kMaxDecode = 8;       // maximum decode time, as a multiple of Draco's
// Maximum time of the WebAssembly decoder, as a multiple of the native decoder's time.
constexpr double kMaxWasm = 2;
constexpr double kMaxBytes = 60;        // bytes of memory per triangle in the WebAssembly decoder
constexpr double kMaxBuildBytes = 250;  // bytes of memory per triangle during a build
// Maximum ratio of the largest model's build time per triangle to that of a smaller one.
constexpr double kMaxGrowth = 1.5;

struct MedianPair {
  double ours, peer;
};

// Runs the two functions alternately, so that a slow phase of the machine affects both. Returns the
// median of each.
MedianPair interleave(const std::function<double()>& ours, const std::function<double()>& peer) {
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

void compare(Report& report, const std::string& what, const char* key, const MedianPair& m,
             double limit) {
  report.add({what, key, m.ours, m.peer, m.ours / m.peer, limit});
}

struct WasmDecode {
  double seconds = 0, bytes = 0;
};

std::string output_of(const std::string& command) {
  std::FILE* pipe = ::popen(command.c_str(), "r");
  std::string output;
  std::array<char, 4096> part{};
  while (pipe != nullptr && std::feof(pipe) == 0)
    output.append(part.data(), std::fread(part.data(), 1, part.size(), pipe));
  if (pipe == nullptr || ::pclose(pipe) != 0)
    throw std::runtime_error("this did not run: " + command);
  return output;
}

// Decodes a file with the browser's decoder in Node. Returns the processor time and the memory.
WasmDecode decode_in_wasm(const char* pmesh) {
  WasmDecode took;
  std::istringstream(output_of(std::string("node '" VITRINE_SOURCE_DIR
                                           "/tests/bench/codec/decode_wasm.mjs' '" VITRINE_BIN_DIR
                                           "/../wasm/progressive-mesh.wasm' '") +
                               pmesh + "'")) >>
      took.seconds >> took.bytes;
  return took;
}

MedianPair build_and_simplify(const BenchmarkModel& model) {
  const MeshoptInput flat = meshopt_input(model.clean);
  const std::size_t one_percent = model.clean.faces.size() / 100;
  return interleave([&] { return seconds([&] { build(model.file, kBits); }); },
                    [&] { return seconds([&] { meshopt_simplify_to(flat, one_percent); }); });
}

// Returns the peak memory, in bytes, of `vitrine build` with one thread per core.
double peak_bytes(const BenchmarkModel& model, const std::string& placement) {
  const TemporaryFile mesh(model.file), pmesh({}, ".pmesh");
  const std::string output = output_of(std::string("'" VITRINE_BIN_DIR "/vitrine' build '") +
                                       mesh.path() + "' -o '" + pmesh.path() + "' --force --bits " +
                                       std::to_string(kBits) + " --json --placement " + placement);
  return nlohmann::json::parse(output)["peak_rss_bytes"].get<double>();
}

double at_most(double limit, const BenchmarkModel& model) {
  return model.clean.positions.size() >= kJudgedVertices ? limit : kNoThreshold;
}

void memory_of_builds(Report& report, const BenchmarkModel& model) {
  const auto triangles = static_cast<double>(model.clean.faces.size());
  for (const char* placement : {"midpoint", "pyramid"}) {
    const double bytes = peak_bytes(model, placement);
    report.add({"build." + model.name, std::string(placement) + "_bytes_per_triangle", bytes,
                triangles, bytes / triangles, is_large(model) ? kMaxBuildBytes : kNoThreshold});
  }
}

// Compares the wall times of builds on two threads and on one. The result has no threshold, because
// wall times depend on the machine's other load.
void threads_of_builds(Report& report, const BenchmarkModel& model) {
  const auto on = [&](unsigned threads) {
    return
        [&model, threads] { return wall_seconds([&] { build_on(model.file, kBits, threads); }); };
  };
  compare(report, "build." + model.name, "time_of_2_threads_ratio_to_1", interleave(on(2), on(1)),
          kNoThreshold);
}

}  // namespace

void speeds(Report& report, const BenchmarkModel& model) {
  const Bytes pmesh = build(model.file, kBits);
  const Bytes draco = draco_encode(model.clean, kBits);
  const auto faces = model.clean.faces.size();
  if (decode(pmesh) != faces) throw std::runtime_error(model.name + " does not decode whole");

  const auto native = [&] { return seconds([&] { decode(pmesh); }); };
  compare(report, "decode", "ratio_to_draco",
          interleave(native, [&] { return seconds([&] { draco_decode(draco); }); }),
          at_most(kMaxDecode, model));
  const TemporaryFile file(pmesh);
  compare(report, "wasm", "ratio_to_native",
          interleave([&] { return decode_in_wasm(file.path()).seconds; }, native),
          at_most(kMaxWasm, model));
  const double bytes = decode_in_wasm(file.path()).bytes;
  const auto triangles = static_cast<double>(faces);
  report.add({"wasm", "bytes_per_triangle", bytes, triangles, bytes / triangles,
              at_most(kMaxBytes, model)});
}

void builds(Report& report, const BenchmarkModel& model, const BenchmarkModel& largest) {
  const MedianPair common = build_and_simplify(model);
  compare(report, "build", "ratio_to_meshopt_simplify", common, at_most(kMaxBuild, model));
  memory_of_builds(report, largest);
  threads_of_builds(report, largest);
  if (&largest == &model) return;
  const MedianPair large = build_and_simplify(largest);
  const std::string what = "build." + largest.name;
  compare(report, what, "ratio_to_meshopt_simplify", large,
          is_large(largest) ? kMaxLargeBuild : kNoThreshold);
  const double own = large.ours / static_cast<double>(largest.clean.faces.size()),
               other = common.ours / static_cast<double>(model.clean.faces.size());
  report.add(
      {what, "time_per_triangle_ratio_to_" + model.name, own, other, own / other, kMaxGrowth});
}

}  // namespace vitrine::bench
