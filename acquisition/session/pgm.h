// SPDX-License-Identifier: Apache-2.0
// Reads and writes frames as binary PGM files (P5, 8 bits), which are lossless and widely
// supported.
#pragma once

#include <span>

#include "acquisition/frame/frame.h"
#include "codec/core/expected.h"

namespace vitrine::acquisition {

std::vector<std::uint8_t> to_pgm(const Frame& frame);

// Parses a frame that to_pgm() wrote. Fails with kBadInput if the bytes are anything else.
Expected<Frame> from_pgm(std::span<const std::uint8_t> file);

}  // namespace vitrine::acquisition
