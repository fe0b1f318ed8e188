// SPDX-License-Identifier: Apache-2.0
#include "codec/picture/write_picture.h"

#include <turbojpeg.h>

#include <memory>

namespace vitrine::inline codec {

Expected<std::vector<std::uint8_t>> write_jpeg(const Picture& picture, int quality) {
  const std::unique_ptr<void, int (*)(tjhandle)> jpeg(tjInitCompress(), tjDestroy);
  if (!jpeg) return fail(ErrorCode::kUnsupported, tjGetErrorStr2(nullptr));
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  const int failed = tjCompress2(jpeg.get(), picture.pixels.data(), static_cast<int>(picture.width),
                                 0, static_cast<int>(picture.height), TJPF_RGBA, &bytes, &size,
                                 TJSAMP_444, quality, 0);
  const std::unique_ptr<unsigned char, void (*)(unsigned char*)> freed(bytes, tjFree);
  if (failed != 0) return fail(ErrorCode::kUnsupported, tjGetErrorStr2(jpeg.get()));
  return std::vector<std::uint8_t>(bytes, bytes + size);
}

}  // namespace vitrine::inline codec
