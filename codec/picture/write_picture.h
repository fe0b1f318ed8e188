// SPDX-License-Identifier: Apache-2.0
// Writes a picture as a PNG [PNG], JPEG [JPEG] or WebP file [WebP]. Each function returns the bytes
// of the file. Fails (kUnsupported) with the reason that the library gives; the caller adds the
// next step.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/core/expected.h"
#include "codec/picture/picture.h"

namespace vitrine::inline codec {

Expected<std::vector<std::uint8_t>> write_png(const Picture& picture);

// `quality` is 1 to 100 as libjpeg defines it. Colours are stored at full resolution (4:4:4);
// opacity is dropped.
Expected<std::vector<std::uint8_t>> write_jpeg(const Picture& picture, int quality);

// `quality` is 0 to 100 as libwebp defines it. If any pixel is not opaque, stores opacity without
// loss.
Expected<std::vector<std::uint8_t>> write_webp(const Picture& picture, int quality);

}  // namespace vitrine::inline codec
