// SPDX-License-Identifier: Apache-2.0
// The text of a token: "vtr_" and 32 random bytes in base64url without padding. Whoever knows it
// has its role; the installation keeps its SHA-256 alone. The bytes are random, so that no salt and
// no slow hash is needed.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "codec/core/sha256.h"

namespace vitrine {

std::string generate_token();

// The hash of a presented token; nothing where the text has not the form of one.
std::optional<Sha256> token_hash(std::string_view text) noexcept;

}  // namespace vitrine
