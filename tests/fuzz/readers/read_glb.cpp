// SPDX-License-Identifier: Apache-2.0
#include "codec/import/read_mesh.h"
#include "fuzz/readers/reader.h"

namespace {

// Returns the memory bound for a file. The bound is larger for files that may contain compressed
// data or pictures, because decoding them needs memory. It is also larger for files with a
// backslash, because a JSON escape may hide the words "compression" and "image".
vitrine::test::HeapBound heap_for(std::string_view glb) {
  for (const char* word : {"compression", "image", "\\"}) {
    if (glb.find(word) != glb.npos) return vitrine::test::kReadingCompressedHeap;
  }
  return vitrine::test::kReadingGlbHeap;
}

}  // namespace

// Reads the input through read_mesh(), which accepts every format and needs Draco. The fuzzers of
// formats without Draco call their readers directly.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto heap = heap_for({reinterpret_cast<const char*>(data), size});
  return vitrine::fuzz::check({data, size}, heap, [](std::span<const std::uint8_t> bytes) {
    // A WebP may have far more pixels than bytes. So the memory is only bounded if the number of
    // pixels is limited.
    const vitrine::Limits limits{.pixels = 1024 * (bytes.size() + 1)};
    return vitrine::read_mesh(bytes, {.limits = limits, .up = vitrine::UpAxis::kZ});
  });
}
