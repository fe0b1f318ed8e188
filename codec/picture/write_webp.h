// SPDX-License-Identifier: Apache-2.0
// Writes a picture as a WebP file.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/core/expected.h"
#include "codec/picture/picture.h"

namespace vitrine::inline codec {

// `quality` is 0 to 100 as libwebp defines it. Opacity is written without loss if a pixel is not
// opaque. Fails with kUnsupported. The message states the reason; the caller must add what the user
// can do.
Expected<std::vector<std::uint8_t>> write_webp(const Picture& picture, int quality);

}  // namespace vitrine::inline codec
