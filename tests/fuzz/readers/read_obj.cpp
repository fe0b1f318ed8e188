// SPDX-License-Identifier: Apache-2.0
#include "fuzz/readers/reader.h"

// The input is also the material library "m" beside it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > vitrine::fuzz::kMostBytes) return 0;
  const std::span<const std::uint8_t> bytes(data, size);
  const vitrine::Companions beside{{"m", bytes}};
  vitrine::fuzz::check(vitrine::read_obj(bytes, beside));
  return 0;
}
