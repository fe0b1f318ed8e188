// SPDX-License-Identifier: Apache-2.0
#include "fuzz/readers/picture.h"
#include "fuzz/readers/reader.h"

// The picture "p" lies beside the input.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > vitrine::fuzz::kMostBytes) return 0;
  const vitrine::Companions beside{{"p", vitrine::fuzz::kPicture}};
  vitrine::fuzz::check({data, size}, vitrine::read_ply({data, size}, beside));
  return 0;
}
