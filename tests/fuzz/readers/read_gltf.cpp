// SPDX-License-Identifier: Apache-2.0
#include "codec/import/read_mesh.h"
#include "fuzz/readers/picture.h"
#include "fuzz/readers/reader.h"

// Reads the input as a glTF file. The file can refer to the buffer "b", which is the input itself,
// and to the picture "p". Uses read_mesh(), like the fuzzer of GLB.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return vitrine::fuzz::check(
      {data, size}, vitrine::test::kReadingCompressedHeap,
      [](std::span<const std::uint8_t> bytes) -> vitrine::Expected<vitrine::ImportedMesh> {
        if (!vitrine::is_gltf(bytes)) return vitrine::bad_input("not glTF");
        const vitrine::Companions beside{{"b", bytes}, {"p", vitrine::fuzz::kPicture}};
        const vitrine::Limits limits{.pixels = 1024 * (bytes.size() + 1)};
        return vitrine::read_mesh(bytes, {.limits = limits, .beside = beside});
      });
}
