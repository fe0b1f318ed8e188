// SPDX-License-Identifier: Apache-2.0
#include "server/config/webhook_key.h"

#include <optional>

#include "server/config/base64.h"

namespace vitrine::server {

Expected<std::string> webhook_key(std::string_view text) {
  constexpr std::string_view kBegin = "whsec_";
  constexpr std::size_t kLeast = 24, kMost = 64, kLongest = 4 * kMost;
  if (text.empty()) return std::string();
  const auto key = text.starts_with(kBegin) && text.size() < kLongest
                       ? decode_base64(text.substr(kBegin.size()))
                       : std::nullopt;
  if (!key || key->size() < kLeast || key->size() > kMost) {
    return fail(ErrorCode::kBadInput,
                "the secret is not whsec_ and 24 to 64 bytes in Base64; make one with: echo "
                "whsec_$(openssl rand -base64 32)");
  }
  return *key;
}

}  // namespace vitrine::server
