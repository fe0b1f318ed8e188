// SPDX-License-Identifier: Apache-2.0
#include "server/content/object.h"

namespace vitrine::server {

Expected<std::vector<std::uint8_t>> Object::read(std::uint64_t offset, std::uint64_t length) const {
  if (offset > size() || length > size() - offset) {
    return fail(ErrorCode::kIo, "read beyond the end of an object; check the data folder");
  }
  std::vector<std::uint8_t> bytes(length);
  if (auto done = read(offset, std::span(bytes)); !done) return tl::unexpected(done.error());
  return bytes;
}

}  // namespace vitrine::server
