// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "codec/core/expected.h"
#include "codec/render/picture.h"

namespace vitrine {

// The bytes of a PNG file. Fails (kUnsupported) with libpng's reason.
Expected<std::vector<std::uint8_t>> write_png(const Picture& picture);

}  // namespace vitrine
