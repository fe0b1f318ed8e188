// SPDX-License-Identifier: Apache-2.0
// bench-decode: prints the processor time, in seconds, for decoding a .pmesh file on one thread:
// the median of five runs. hardening.py compares two builds of this program.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <span>
#include <stdexcept>
#include <utility>

#include "../codec/processor_time.h"
#include "codec/build/open_model.h"
#include "codec/files/read_file.h"
#include "support/product_names.h"

namespace vitrine::bench {
namespace {

template <class T>
T checked(Expected<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return std::move(*result);
}

void decode(std::span<const std::uint8_t> pmesh) {
  Refiner refiner = checked(open_model(pmesh));
  const ChunkReader read = chunks_of(refiner.manifest(), pmesh);
  for (std::size_t i = 0; i < refiner.manifest().chunks.size(); ++i) {
    const auto applied = refiner.apply(i, checked(read(i)));
    if (!applied) throw std::runtime_error(applied.error().message);
  }
}

int run(const char* path) {
  const auto pmesh = checked(read_file(path, UINT64_MAX));
  std::array<double, 5> times{};
  for (double& time : times)
    time = seconds([&] { decode(pmesh); });
  std::ranges::sort(times);
  std::printf("%.6f\n", times[times.size() / 2]);
  return 0;
}

}  // namespace
}  // namespace vitrine::bench

int main(int argc, char** argv) {
  const bool help = argc == 2 && std::strcmp(argv[1], "--help") == 0;
  if (argc != 2 || help) {
    std::fputs("Usage: bench-decode FILE.pmesh\n", help ? stdout : stderr);
    return help ? 0 : 2;
  }
  try {
    return vitrine::bench::run(argv[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench-decode: %s\n", error.what());
    return 1;
  }
}
