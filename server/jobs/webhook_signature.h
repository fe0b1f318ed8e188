// SPDX-License-Identifier: Apache-2.0
// Signs webhooks, so that their receivers can tell genuine messages from forged and repeated ones
// ([StandardWebhooks], symmetric signatures).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace vitrine::server {

// Returns the header fields of a message: webhook-id, webhook-timestamp and webhook-signature. The
// signature is the HMAC-SHA256 of "ID.SECONDS.BODY" in Base64, after "v1,". `id` is the same each
// time that a message is sent, so that a receiver can ignore repetitions. `seconds` is the time of
// sending, since 1970, UTC; receivers refuse old times. `key` is not empty.
std::vector<std::string> signature_fields(std::string_view key, std::string_view id,
                                          std::int64_t seconds, std::string_view body);

}  // namespace vitrine::server
