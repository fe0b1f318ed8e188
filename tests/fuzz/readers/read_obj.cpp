// SPDX-License-Identifier: Apache-2.0
#include "fuzz/readers/picture.h"
#include "fuzz/readers/reader.h"

// Reads the input as an OBJ file. The file can refer to the material library "m", which is the
// input itself, and to the picture "p".
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return vitrine::fuzz::check(
      {data, size}, vitrine::test::kReadingHeap, [](std::span<const std::uint8_t> bytes) {
        const vitrine::Companions beside{{"m", bytes}, {"p", vitrine::fuzz::kPicture}};
        return vitrine::fuzz::finished(bytes, vitrine::read_obj(bytes, {.beside = beside}));
      });
}
