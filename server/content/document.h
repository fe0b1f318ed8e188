// SPDX-License-Identifier: Apache-2.0
// A public JSON text that is kept in memory, with its entity tag and its compressed form.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace vitrine::server {

struct Document {
  std::string text, etag;
  std::vector<std::uint8_t> gzip;  // `text` as a gzip file; empty if it is not compressed
};

}  // namespace vitrine::server
