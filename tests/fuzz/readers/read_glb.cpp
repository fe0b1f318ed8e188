// SPDX-License-Identifier: Apache-2.0
#include "fuzz/readers/reader.h"

// Through the door of all formats: the one program in which none of them reaches Draco.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size <= vitrine::fuzz::kMostBytes)
    vitrine::fuzz::check(vitrine::read_mesh({data, size}, {.up = vitrine::UpAxis::kZ}));
  return 0;
}
