// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/webhook_signature.h"

#include <fmt/core.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>

#include <array>

namespace vitrine::server {
namespace {

const unsigned char* bytes_of(std::string_view text) {
  return reinterpret_cast<const unsigned char*>(text.data());
}

std::string hmac_in_base64(std::string_view key, std::string_view text) {
  constexpr std::size_t kBytes = 32, kCharacters = 44;
  std::array<unsigned char, kBytes> code{};
  std::array<unsigned char, kCharacters + 1> base64{};  // OpenSSL appends a null byte
  ::HMAC(EVP_sha256(), key.data(), static_cast<int>(key.size()), bytes_of(text), text.size(),
         code.data(), nullptr);
  ::EVP_EncodeBlock(base64.data(), code.data(), kBytes);
  return {reinterpret_cast<const char*>(base64.data()), kCharacters};
}

}  // namespace

std::vector<std::string> signature_fields(std::string_view key, std::string_view id,
                                          std::int64_t seconds, std::string_view body) {
  const std::string code = hmac_in_base64(key, fmt::format("{}.{}.{}", id, seconds, body));
  return {fmt::format("webhook-id: {}", id), fmt::format("webhook-timestamp: {}", seconds),
          fmt::format("webhook-signature: v1,{}", code)};
}

}  // namespace vitrine::server
