// SPDX-License-Identifier: Apache-2.0
// Reads the secret that signs webhooks.
#pragma once

#include <string>
#include <string_view>

#include "codec/core/expected.h"

namespace vitrine::server {

// Returns the bytes of the key in `text`: "whsec_" and 24 to 64 bytes in Base64, as
// [StandardWebhooks] demands. Returns an empty key if `text` is empty. Fails (kBadInput) otherwise;
// the message does not repeat the key.
Expected<std::string> webhook_key(std::string_view text);

}  // namespace vitrine::server
