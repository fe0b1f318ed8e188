// SPDX-License-Identifier: Apache-2.0
// Verifies the checksum that a client sends with a body ([tus], extension checksum).
#pragma once

#include <openssl/evp.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace vitrine::server {

class BodyChecksum {
 public:
  static constexpr std::string_view kAlgorithms = "sha1,sha256,md5";

  // Parses the value of an Upload-Checksum field: the algorithm's name, a space, and the hash in
  // Base64. Returns nullopt if the value is malformed or the algorithm is not supported.
  static std::optional<BodyChecksum> parse(std::string_view field);

  void add(std::span<const std::uint8_t> piece);

  // Whether the pieces so far have the expected hash. Call this once, after the last piece.
  bool is_met();

 private:
  struct Free {
    void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
  };

  BodyChecksum(const EVP_MD* algorithm, std::string expected);

  std::unique_ptr<EVP_MD_CTX, Free> context_;
  std::string expected_;
};

}  // namespace vitrine::server
