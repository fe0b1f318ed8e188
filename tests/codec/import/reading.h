// SPDX-License-Identifier: Apache-2.0
// Short forms for the tests of the readers.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "codec/import/mesh_builders.h"
#include "codec/import/read_mesh.h"

namespace vitrine::testing {

inline ImportedMesh read_text(std::string_view text) {
  auto result = read_mesh(as_bytes(text));
  EXPECT_TRUE(result.has_value()) << result.error().message;
  return result ? *std::move(result) : ImportedMesh{};
}

// The message with which the reader refuses the text.
inline std::string refusal(std::string_view text) {
  const auto result = read_mesh(as_bytes(text));
  EXPECT_FALSE(result.has_value());
  return result ? "" : result.error().message;
}

template <class T>
std::string bytes_of(std::initializer_list<T> values, bool big_endian = false) {
  std::string out;
  for (const T value : values) {
    std::string raw(reinterpret_cast<const char*>(&value), sizeof(T));
    if (big_endian) std::reverse(raw.begin(), raw.end());
    out += raw;
  }
  return out;
}

}  // namespace vitrine::testing
