// SPDX-License-Identifier: Apache-2.0
#include "codec/import/read_mesh.h"
#include "fuzz/readers/picture.h"
#include "fuzz/readers/reader.h"

// Reads the input as an FBX file, which can refer to the picture "p". The system's Assimp is
// compiled without sanitizers.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return vitrine::fuzz::check(
      {data, size}, vitrine::test::kReadingFbxHeap,
      [](std::span<const std::uint8_t> bytes) -> vitrine::Expected<vitrine::ImportedMesh> {
        if (!vitrine::is_fbx(bytes)) return vitrine::bad_input("not FBX");
        const vitrine::Limits limits{.pixels = 1024 * (bytes.size() + 1)};
        return vitrine::read_mesh(bytes,
                                  {.limits = limits, .beside = {{"p", vitrine::fuzz::kPicture}}});
      });
}
