// SPDX-License-Identifier: Apache-2.0
#include "fuzz/readers/picture.h"
#include "fuzz/readers/reader.h"

// The input is also the material library "m" beside it, and the picture "p" lies there too.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > vitrine::fuzz::kMostBytes) return 0;
  const std::span<const std::uint8_t> bytes(data, size);
  const vitrine::Companions beside{{"m", bytes}, {"p", vitrine::fuzz::kPicture}};
  vitrine::fuzz::check(bytes, vitrine::read_obj(bytes, beside));
  return 0;
}
