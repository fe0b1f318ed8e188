// SPDX-License-Identifier: Apache-2.0
// Frames as binary PGM files (P5, 8 bits), which lose nothing and which everything can show.
#pragma once

#include <span>

#include "acquisition/frame/frame.h"
#include "codec/core/expected.h"

namespace vitrine {

std::vector<std::uint8_t> to_pgm(const Frame& frame);

// Fails (kBadInput) on anything but what to_pgm() gives.
Expected<Frame> from_pgm(std::span<const std::uint8_t> file);

}  // namespace vitrine
