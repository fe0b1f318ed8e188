// SPDX-License-Identifier: Apache-2.0
#include "fuzz/readers/picture.h"
#include "fuzz/readers/reader.h"

// Reads the input as a PLY file, which can refer to the picture "p".
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return vitrine::fuzz::check(
      {data, size}, vitrine::test::kReadingHeap, [](std::span<const std::uint8_t> bytes) {
        const vitrine::Companions beside{{"p", vitrine::fuzz::kPicture}};
        return vitrine::fuzz::finished(bytes, vitrine::read_ply(bytes, {.beside = beside}));
      });
}
