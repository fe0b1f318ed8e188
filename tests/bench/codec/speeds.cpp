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
#include "temporary_file.h"

namespace vitrine::bench {
namespace {

constexpr int kRounds = 5;
// On a smaller scan what is paid once weighs more than what is paid for each triangle.
constexpr std::size_t kJudgedVertices = 100'000;
constexpr double kMaxBuild = 20;        // times one meshopt_simplify
constexpr double kMaxLargeBuild = 15;   // the same, of the largest model, where that is large
constexpr double kMaxDecode = 8;        // times Draco's decoder
constexpr double kMaxWasm = 2;          // times the native decoder
constexpr double kMaxBytes = 60;        // of the WebAssembly decoder's memory per triangle
constexpr double kMaxBuildBytes = 250;  // of a build's memory per triangle
constexpr double kMaxGrowth = 1.5;      // of a build's time per triangle, to a model of common size

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

void compare(Report& report, const std::string& what, const char* key, const Medians& m,
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

// What the browser's decoder takes in Node for the same file: processor time and memory.
WasmDecode decode_in_wasm(const char* pmesh) {
  WasmDecode took;
  std::istringstream(output_of(std::string("node '" VITRINE_SOURCE_DIR
                                           "/tests/bench/codec/decode_wasm.mjs' '" VITRINE_BIN_DIR
                                           "/../wasm/progressive-mesh.wasm' '") +
                               pmesh + "'")) >>
      took.seconds >> took.bytes;
  return took;
}

Medians build_and_simplify(const Model& model) {
  const MeshoptInput flat = meshopt_input(model.clean);
  const std::size_t one_percent = model.clean.faces.size() / 100;
  return interleave([&] { return seconds([&] { build(model.file, kBits); }); },
                    [&] { return seconds([&] { meshopt_simplify_to(flat, one_percent); }); });
}

// The most memory that `vitrine build` holds at a time, with a thread for each core.
double peak_bytes(const Model& model, const std::string& placement) {
  const TemporaryFile mesh(model.file), pmesh({}, ".pmesh");
  const std::string output = output_of(std::string("'" VITRINE_BIN_DIR "/vitrine' build '") +
                                       mesh.path() + "' -o '" + pmesh.path() + "' --bits " +
                                       std::to_string(kBits) + " --json --placement " + placement);
  return nlohmann::json::parse(output)["peak_rss_bytes"].get<double>();
}

double at_most(double limit, const Model& model) {
  return model.clean.positions.size() >= kJudgedVertices ? limit : kNoThreshold;
}

void memory_of_builds(Report& report, const Model& model) {
  const auto triangles = static_cast<double>(model.clean.faces.size());
  for (const char* placement : {"midpoint", "pyramid"}) {
    const double bytes = peak_bytes(model, placement);
    report.add({"build." + model.name, std::string(placement) + "_bytes_per_triangle", bytes,
                triangles, bytes / triangles, is_large(model) ? kMaxBuildBytes : kNoThreshold});
  }
}

}  // namespace

void speeds(Report& report, const Model& model) {
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

void builds(Report& report, const Model& model, const Model& largest) {
  const Medians common = build_and_simplify(model);
  compare(report, "build", "ratio_to_meshopt_simplify", common, at_most(kMaxBuild, model));
  memory_of_builds(report, largest);
  if (&largest == &model) return;
  const Medians large = build_and_simplify(largest);
  const std::string what = "build." + largest.name;
  compare(report, what, "ratio_to_meshopt_simplify", large,
          is_large(largest) ? kMaxLargeBuild : kNoThreshold);
  const double own = large.ours / static_cast<double>(largest.clean.faces.size()),
               other = common.ours / static_cast<double>(model.clean.faces.size());
  report.add(
      {what, "time_per_triangle_ratio_to_" + model.name, own, other, own / other, kMaxGrowth});
}

}  // namespace vitrine::bench
