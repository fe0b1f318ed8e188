// SPDX-License-Identifier: Apache-2.0
// Writes a picture as a JPEG file [JPEG].
#pragma once

#include <cstdint>
#include <vector>

#include "codec/core/expected.h"
#include "codec/picture/picture.h"

namespace vitrine::inline codec {

// `quality` is 1 to 100 as libjpeg defines it. Colours are stored at full resolution (4:4:4);
// opacity is dropped. Fails (kUnsupported) with the error message of TurboJPEG; the caller adds the
// next step.
Expected<std::vector<std::uint8_t>> write_jpeg(const Picture& picture, int quality);

}  // namespace vitrine::inline codec
