// SPDX-License-Identifier: Apache-2.0
// fuzz_base_seeds FOLDER: writes base meshes of several kinds as seeds for the base fuzzer.
#include <cstdio>
#include <fstream>
#include <string>

#include "codec/base/base_encoder.h"
#include "support/random_mesh.h"

int main(int argc, char** argv) {
  using namespace vitrine;
  if (argc != 2) return 2;
  for (std::uint64_t seed = 0; seed < 24; ++seed) {
    const auto mesh = test::random_mesh(seed, seed % 2 == 0 ? 20 : 80);
    const auto base = encode_base({.positions = mesh.positions,
                                   .faces = mesh.faces,
                                   .attributes = lattice_attributes(mesh.attributes)});
    if (!base) return std::puts(base.error().message.c_str()), 1;
    std::ofstream(argv[1] + std::string("/random_") + std::to_string(seed), std::ios::binary)
        .write(reinterpret_cast<const char*>(base->bytes.data()),
               static_cast<std::streamsize>(base->bytes.size()));
  }
  return 0;
}
