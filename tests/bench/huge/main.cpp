// SPDX-License-Identifier: Apache-2.0
// bench-huge: builds a mesh of 20 million triangles, made from a scan in the repository. Prints the
// time, and the peak memory of the largest process as a share of 2 GiB. The exit code is 0 only if
// that share is at most 1 and the file is proven lossless.
#include <sys/resource.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "../codec/report.h"
#include "codec/import/read_mesh.h"
#include "codec/repair/repair.h"
#include "subdivided_mesh.h"
#include "support/product_names.h"

namespace vitrine::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kTriangles = 20'000'000;
constexpr double kMostBytes = 2.0 * (1u << 30);
constexpr const char* kUsage =
    "Usage: bench-huge [--json] [--triangles N] [--mesh OUT.ply]\n"
    "--triangles: at least that many (default 20,000,000)\n"
    "--mesh: only write the mesh\n";

struct HugeOptions {
  bool json = false;
  std::uint64_t triangles = kTriangles;
  std::string mesh;
};

bool parse(int argc, char** argv, HugeOptions& options) {
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    if (name == "--json") {
      options.json = true;
    } else if (name == "--triangles" && i + 1 < argc) {
      options.triangles = std::strtoull(argv[++i], nullptr, 10);
    } else if (name == "--mesh" && i + 1 < argc) {
      options.mesh = argv[++i];
    } else {
      return false;
    }
  }
  return options.triangles > 0;
}

TriangleMesh read_scan() {
  std::ifstream in(VITRINE_SOURCE_DIR "/tests/models/demosthenes.obj", std::ios::binary);
  const std::vector<std::uint8_t> file{std::istreambuf_iterator<char>(in), {}};
  auto imported = read_mesh(file);
  if (!imported) throw std::runtime_error(imported.error().message);
  auto repaired = repair(std::move(*imported));
  if (!repaired) throw std::runtime_error(repaired.error().message);
  return std::move(repaired->mesh);
}

std::uint64_t write_mesh(const fs::path& path, std::uint64_t triangles) {
  std::ofstream out(path, std::ios::binary);
  const std::uint64_t written = write_subdivided(read_scan(), triangles, out);
  if (!out.flush()) throw std::runtime_error("cannot write " + path.string());
  return written;
}

// A temporary folder on the disk of the build tree. The destructor removes it.
class WorkFolder {
 public:
  WorkFolder() {
    if (::mkdtemp(path_.data()) == nullptr) throw std::runtime_error("cannot make " + path_);
  }
  ~WorkFolder() { fs::remove_all(path_); }
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;
  fs::path operator/(const char* name) const { return fs::path(path_) / name; }

 private:
  std::string path_ = VITRINE_BIN_DIR "/../bench-huge-XXXXXX";
};

void run_vitrine(const std::string& arguments) {
  const std::string command = "'" VITRINE_BIN_DIR "/vitrine' " + arguments + " > /dev/null";
  if (std::system(command.c_str()) != 0) throw std::runtime_error("this failed: " + command);
}

// Returns the peak memory, in bytes, of the ended child process that used the most. This process is
// vitrine, or the child process in which vitrine reads and builds.
double peak_bytes() {
  rusage children{};
  ::getrusage(RUSAGE_CHILDREN, &children);
  return 1024.0 * static_cast<double>(children.ru_maxrss);
}

int run(const HugeOptions& options) {
  if (!options.mesh.empty()) {
    std::printf("%llu triangles\n",
                static_cast<unsigned long long>(write_mesh(options.mesh, options.triangles)));
    return 0;
  }
  const WorkFolder folder;
  const std::string mesh = folder / "mesh.ply", pmesh = folder / "mesh.pmesh";
  const auto triangles = static_cast<double>(write_mesh(mesh, options.triangles));
  const auto start = std::chrono::steady_clock::now();
  run_vitrine("build '" + mesh + "' --force -o '" + pmesh + "'");
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const double bytes = peak_bytes();  // peak memory before the verification, which may use more
  run_vitrine("verify '" + pmesh + "' --against '" + mesh + "'");
  Report report(options.json);
  report.add({"huge", "peak_bytes_to_2_GiB", bytes, kMostBytes, bytes / kMostBytes, 1});
  report.add({"huge", "seconds_per_million_triangles", seconds, triangles / 1e6,
              seconds / (triangles / 1e6), kNoThreshold});
  return report.finish() ? 0 : 1;
}

}  // namespace
}  // namespace vitrine::bench

int main(int argc, char** argv) {
  using namespace vitrine::bench;
  if (argc == 2 && std::string_view(argv[1]) == "--help") return std::fputs(kUsage, stdout), 0;
  HugeOptions options;
  if (!parse(argc, argv, options)) return std::fputs(kUsage, stderr), 2;
  try {
    return run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench-huge: %s\n", error.what());
    return 1;
  }
}
