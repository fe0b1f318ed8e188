// SPDX-License-Identifier: Apache-2.0
// Writes a picture as a PNG file [PNG].
#pragma once

#include "codec/core/expected.h"
#include "codec/picture/picture.h"

namespace vitrine::inline codec {

// Returns the bytes of the PNG file. Fails (kUnsupported) with the error message of libpng; the
// caller adds the next step.
Expected<std::vector<std::uint8_t>> write_png(const Picture& picture);

}  // namespace vitrine::inline codec
