// SPDX-License-Identifier: Apache-2.0
#include "codec/import/read_mesh.h"
#include "fuzz/readers/reader.h"

// Reads the input as the model part of a 3MF file. It can refer to the part "o.model", which is the
// input itself. The memory bound does not include pugixml, which allocates with malloc().
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return vitrine::fuzz::check(
      {data, size}, vitrine::test::kReadingGlbHeap,
      [](std::span<const std::uint8_t> bytes) -> vitrine::Expected<vitrine::ImportedMesh> {
        if (!vitrine::is_3mf(bytes)) return vitrine::bad_input("not 3MF");
        return vitrine::read_mesh(bytes, {.beside = {{"o.model", bytes}}});
      });
}
