// SPDX-License-Identifier: Apache-2.0
#include "codec/import/read_mesh.h"
#include "fuzz/readers/picture.h"
#include "fuzz/readers/reader.h"

// Reads the input as a DAE file, which can refer to the picture "p". The memory bound does not
// include pugixml, which allocates with malloc().
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return vitrine::fuzz::check(
      {data, size}, vitrine::test::kReadingHeap,
      [](std::span<const std::uint8_t> bytes) -> vitrine::Expected<vitrine::ImportedMesh> {
        if (!vitrine::is_dae(bytes)) return vitrine::bad_input("not DAE");
        return vitrine::read_mesh(bytes, {.beside = {{"p", vitrine::fuzz::kPicture}}});
      });
}
