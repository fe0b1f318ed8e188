// SPDX-License-Identifier: Apache-2.0
// fuzz_decode_seed FILE.pmesh SEED: converts a valid `.pmesh` to a seed for the decode fuzzer.
#include <cstdio>
#include <fstream>
#include <iterator>

#include "codec/base/base_decoder.h"
#include "raw_base.h"

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  std::ifstream in(argv[1], std::ios::binary);
  const std::vector<char> file{std::istreambuf_iterator<char>(in), {}};
  const std::span<const std::uint8_t> bytes(reinterpret_cast<const std::uint8_t*>(file.data()),
                                            file.size());
  const auto manifest = vitrine::parse_header(bytes);
  if (!manifest) return std::puts(manifest.error().message.c_str()), 1;
  const auto base =
      vitrine::decode_base(bytes.subspan(manifest->base_offset, manifest->base_length), *manifest);
  if (!base) return std::puts(base.error().message.c_str()), 1;
  const auto seed = vitrine::fuzz::with_raw_base(bytes, *manifest, *base);
  std::ofstream(argv[2], std::ios::binary)
      .write(reinterpret_cast<const char*>(seed.data()), static_cast<std::streamsize>(seed.size()));
  return 0;
}
