// SPDX-License-Identifier: Apache-2.0
#include "server/config/base64.h"

#include <openssl/evp.h>

#include <algorithm>
#include <cctype>
#include <limits>

namespace vitrine::server {

// Checks the characters without OpenSSL, which ignores surrounding blanks and accepts padding in
// the middle of the text.
std::optional<std::string> decode_base64(std::string_view text) {
  const std::size_t padding = text.ends_with("==") ? 2 : text.ends_with('=') ? 1 : 0;
  const auto fits = [](unsigned char c) { return std::isalnum(c) || c == '+' || c == '/'; };
  if (text.size() % 4 != 0 || text.size() > std::numeric_limits<int>::max() ||
      !std::ranges::all_of(text.substr(0, text.size() - padding), fits))
    return std::nullopt;
  std::string bytes(text.size() / 4 * 3, '\0');
  if (::EVP_DecodeBlock(reinterpret_cast<unsigned char*>(bytes.data()),
                        reinterpret_cast<const unsigned char*>(text.data()),
                        static_cast<int>(text.size())) < 0)
    return std::nullopt;
  bytes.resize(bytes.size() - padding);
  return bytes;
}

}  // namespace vitrine::server
