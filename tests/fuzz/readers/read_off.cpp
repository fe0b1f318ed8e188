// SPDX-License-Identifier: Apache-2.0
#include "fuzz/readers/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return vitrine::fuzz::check({data, size}, vitrine::test::kReadingHeap,
                              [](std::span<const std::uint8_t> bytes) {
                                return vitrine::fuzz::finished(bytes, vitrine::read_off(bytes, {}));
                              });
}
