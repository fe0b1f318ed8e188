// SPDX-License-Identifier: Apache-2.0
#include "codec/gltf/data_uri.h"

#include <openssl/evp.h>

#include <algorithm>
#include <limits>

namespace vitrine::inline codec {
namespace {

// Decodes base64. Returns nullopt if the text is invalid. Padding is checked and removed here,
// because OpenSSL accepts padding at any position and decodes it as zeros.
std::optional<std::vector<std::uint8_t>> from_base64(std::string_view text) {
  const std::size_t digits = std::min(text.find('='), text.size());
  const std::size_t padding = text.size() - digits;
  if (padding > 2 || text.find_first_not_of('=', digits) != text.npos ||
      text.size() > std::numeric_limits<int>::max())
    return std::nullopt;
  std::vector<std::uint8_t> out(text.size() / 4 * 3);
  const int size = EVP_DecodeBlock(out.data(), reinterpret_cast<const unsigned char*>(text.data()),
                                   static_cast<int>(text.size()));
  if (size < static_cast<int>(padding)) return std::nullopt;
  out.resize(static_cast<std::size_t>(size) - padding);
  return out;
}

}  // namespace

std::optional<std::vector<std::uint8_t>> data_in_uri(std::string_view uri) {
  const std::size_t comma = uri.find(',');
  if (!is_data_uri(uri) || comma == uri.npos) return std::nullopt;
  if (!uri.substr(0, comma).ends_with(";base64")) return std::nullopt;
  return from_base64(uri.substr(comma + 1));
}

}  // namespace vitrine::inline codec
