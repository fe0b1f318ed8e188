// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <functional>
#include <stdexcept>

#include "sections.h"
#include "subject.h"
#include "temporary_file.h"

namespace vitrine::bench {
namespace {

constexpr int kRounds = 5;
// On a smaller scan what is paid once weighs more than what is paid for each triangle.
constexpr std::size_t kJudgedVertices = 100'000;
constexpr double kMaxBuild = 20;   // times one meshopt_simplify
constexpr double kMaxDecode = 20;  // times Draco's decoder
constexpr double kMaxWasm = 2.5;   // times the native decoder

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

}  // namespace

void speeds(Report& report, const Model& model) {
  const bool judged = model.clean.positions.size() >= kJudgedVertices;
  const auto at_most = [&](double limit) { return judged ? limit : kNoThreshold; };
  const Bytes pmesh = build(model.file, kBits);
  const Bytes draco = draco_encode(model.clean, kBits);
  const MeshoptInput flat = meshopt_input(model.clean);
  const auto faces = model.clean.faces.size();
  if (decode(pmesh) != faces) throw std::runtime_error(model.name + " does not decode whole");

  const auto native = [&] { return seconds([&] { decode(pmesh); }); };
  compare(report, "build", "ratio_to_meshopt_simplify",
          interleave([&] { return seconds([&] { build(model.file, kBits); }); },
                     [&] { return seconds([&] { meshopt_simplify_to_one_percent(flat); }); }),
          at_most(kMaxBuild));
  compare(report, "decode", "ratio_to_draco",
          interleave(native, [&] { return seconds([&] { draco_decode(draco); }); }),
          at_most(kMaxDecode));
  const TemporaryFile file(pmesh);
  compare(report, "wasm", "ratio_to_native",
          interleave([&] { return wasm_seconds(file.path()); }, native), at_most(kMaxWasm));
}

}  // namespace vitrine::bench
