// SPDX-License-Identifier: Apache-2.0
#include "codec/picture/write_picture.h"

#include <webp/encode.h>

#include <memory>

namespace vitrine::inline codec {
namespace {

bool has_opacity(const Picture& picture) {
  for (std::size_t i = 3; i < picture.pixels.size(); i += 4) {
    if (picture.pixels[i] != 255) return true;
  }
  return false;
}

int append(const std::uint8_t* data, std::size_t size, const WebPPicture* picture) {
  auto& out = *static_cast<std::vector<std::uint8_t>*>(picture->custom_ptr);
  out.insert(out.end(), data, data + size);
  return 1;
}

}  // namespace

Expected<std::vector<std::uint8_t>> write_webp(const Picture& picture, int quality) {
  WebPConfig config;
  WebPPicture webp;
  if (WebPConfigInit(&config) == 0 || WebPPictureInit(&webp) == 0) {
    return fail(ErrorCode::kUnsupported, "libwebp has another version");
  }
  const std::unique_ptr<WebPPicture, void (*)(WebPPicture*)> freed(&webp, WebPPictureFree);
  std::vector<std::uint8_t> out;
  config.quality = static_cast<float>(quality);
  config.method = 6;  // the slowest method; saves 5 % of the bytes
  webp.width = static_cast<int>(picture.width);
  webp.height = static_cast<int>(picture.height);
  webp.writer = append;
  webp.custom_ptr = &out;
  const int stride = 4 * webp.width;
  const bool imported = has_opacity(picture)
                            ? WebPPictureImportRGBA(&webp, picture.pixels.data(), stride) != 0
                            : WebPPictureImportRGBX(&webp, picture.pixels.data(), stride) != 0;
  if (!imported || WebPEncode(&config, &webp) == 0) {
    return fail(ErrorCode::kUnsupported, "libwebp cannot encode a picture of this size");
  }
  return out;
}

}  // namespace vitrine::inline codec
