// SPDX-License-Identifier: Apache-2.0
// Writes a picture as a WebP file [WebP].
#pragma once

#include <cstdint>
#include <vector>

#include "codec/core/expected.h"
#include "codec/picture/picture.h"

namespace vitrine::inline codec {

// `quality` is 0 to 100 as libwebp defines it. If any pixel is not opaque, stores opacity without
// loss. Fails with kUnsupported. The error states the reason; the caller must add the next step.
Expected<std::vector<std::uint8_t>> write_webp(const Picture& picture, int quality);

}  // namespace vitrine::inline codec
