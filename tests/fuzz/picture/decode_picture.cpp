// SPDX-License-Identifier: Apache-2.0
#include "codec/picture/decode_picture.h"

#include "codec/picture/sample.h"
#include "fuzz/bounded.h"
#include "fuzz/checks.h"

namespace {

constexpr std::uint64_t kPixels = 1 << 16;
// Memory bound: four bytes per pixel, plus the message of an error.
constexpr vitrine::test::HeapBound kHeap{.always = 4 * kPixels + 512, .per_byte = 0};

void check(const vitrine::Picture& picture) {
  using vitrine::fuzz::require;
  const std::uint64_t count = std::uint64_t{picture.width} * picture.height;
  require(count > 0 && count <= kPixels && picture.pixels.size() == 4 * count);
  for (const vitrine::Wrap wrap :
       {vitrine::Wrap::kRepeat, vitrine::Wrap::kMirror, vitrine::Wrap::kClamp}) {
    for (const double at : {-1.0, 0.0, 0.5, 1.0, 7.3})
      require(vitrine::sample(picture, at, 1 - at, wrap, wrap)[0] >= 0);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  vitrine::fuzz::bounded(kHeap, size, [&] {
    const auto picture = vitrine::decode_picture({data, size}, kPixels);
    if (picture)
      check(*picture);
    else
      vitrine::fuzz::require(picture.error().message.find('\n') == std::string::npos);
  });
  return 0;
}
