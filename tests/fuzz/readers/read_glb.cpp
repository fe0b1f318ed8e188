// SPDX-License-Identifier: Apache-2.0
#include "fuzz/readers/reader.h"

namespace {

// A compressed part or a picture counts as what it makes. (A backslash may hide its name.)
vitrine::test::HeapBound heap_for(std::string_view glb) {
  for (const char* word : {"compression", "image", "\\"}) {
    if (glb.find(word) != glb.npos) return vitrine::test::kReadingCompressedHeap;
  }
  return vitrine::test::kReadingGlbHeap;
}

}  // namespace

// Through the door of all formats: the one program in which none of them reaches Draco.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto heap = heap_for({reinterpret_cast<const char*>(data), size});
  return vitrine::fuzz::check({data, size}, heap, [](std::span<const std::uint8_t> bytes) {
    return vitrine::read_mesh(bytes, {.up = vitrine::UpAxis::kZ});
  });
}
