// SPDX-License-Identifier: Apache-2.0
#include "server/messages/body.h"

namespace vitrine::server {

std::uint64_t body_size(const Body& body) {
  if (const auto* text = std::get_if<std::string>(&body)) return text->size();
  if (const auto* shared = std::get_if<SharedBytes>(&body)) return shared->bytes.size();
  return std::get<StoredBytes>(body).length;
}

std::uint64_t body_memory(const Body& body) {
  if (const auto* text = std::get_if<std::string>(&body)) return text->size();
  const auto* shared = std::get_if<SharedBytes>(&body);
  return shared != nullptr && shared->owner != nullptr ? shared->memory : 0;
}

Body body_range(Body body, std::uint64_t offset, std::uint64_t length) {
  if (auto* text = std::get_if<std::string>(&body)) return text->substr(offset, length);
  if (auto* shared = std::get_if<SharedBytes>(&body)) {
    shared->bytes = shared->bytes.subspan(offset, length);
  } else {
    auto& stored = std::get<StoredBytes>(body);
    stored.offset += offset;
    stored.length = length;
  }
  return body;
}

}  // namespace vitrine::server
