// SPDX-License-Identifier: Apache-2.0
#include "fuzz/readers/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size <= vitrine::fuzz::kMostBytes)
    vitrine::fuzz::check({data, size}, vitrine::read_stl({data, size}));
  return 0;
}
