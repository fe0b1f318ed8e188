// SPDX-License-Identifier: Apache-2.0
// The text of an access token: "vtr_" and 32 random bytes in base64url without padding. A client
// that sends the text gets the token's role. The server stores only the SHA-256 of the text. The
// bytes are random, so the hash needs neither a salt nor a slow algorithm.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "codec/core/sha256.h"

namespace vitrine::server {

std::string generate_token();

// Returns the SHA-256 of a token that a client has sent, or nullopt if the text does not have the
// form of a token.
std::optional<Sha256> token_hash(std::string_view text) noexcept;

}  // namespace vitrine::server
