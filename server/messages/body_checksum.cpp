// SPDX-License-Identifier: Apache-2.0
#include "server/messages/body_checksum.h"

#include <array>
#include <new>

#include "server/config/base64.h"

namespace vitrine::server {
namespace {

const EVP_MD* algorithm_of(std::string_view name) {
  if (name == "sha1") return EVP_sha1();
  if (name == "sha256") return EVP_sha256();
  if (name == "md5") return EVP_md5();
  return nullptr;
}

}  // namespace

BodyChecksum::BodyChecksum(const EVP_MD* algorithm, std::string expected)
    : context_(EVP_MD_CTX_new()), expected_(std::move(expected)) {
  if (!context_ || EVP_DigestInit_ex(context_.get(), algorithm, nullptr) != 1)
    throw std::bad_alloc();
}

std::optional<BodyChecksum> BodyChecksum::parse(std::string_view field) {
  const std::size_t blank = field.find(' ');
  const EVP_MD* algorithm = algorithm_of(field.substr(0, blank));
  if (algorithm == nullptr || blank == field.npos) return std::nullopt;
  auto expected = decode_base64(field.substr(blank + 1));
  if (!expected || expected->size() != static_cast<std::size_t>(EVP_MD_get_size(algorithm)))
    return std::nullopt;
  return BodyChecksum(algorithm, std::move(*expected));
}

void BodyChecksum::add(std::span<const std::uint8_t> piece) {
  EVP_DigestUpdate(context_.get(), piece.data(), piece.size());
}

bool BodyChecksum::is_met() {
  std::array<unsigned char, EVP_MAX_MD_SIZE> hash;
  unsigned size = 0;
  EVP_DigestFinal_ex(context_.get(), hash.data(), &size);
  return expected_ == std::string_view(reinterpret_cast<const char*>(hash.data()), size);
}

}  // namespace vitrine::server
