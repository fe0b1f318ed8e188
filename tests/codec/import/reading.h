// SPDX-License-Identifier: Apache-2.0
// Helpers for tests of the readers.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <string_view>

#include "codec/import/mesh_builders.h"
#include "codec/import/read_mesh.h"
#include "codec/repair/notes.h"

namespace vitrine::testing {

inline ImportedMesh read_text(std::string_view text) {
  auto result = read_mesh(as_bytes(text));
  EXPECT_TRUE(result.has_value()) << result.error().message;
  if (result) expect_counts_and_steps(result->repairs);
  return result ? *std::move(result) : ImportedMesh{};
}

// Expects that the reader refuses the file `text`. Returns the error message.
inline std::string refusal(std::string_view text) {
  const auto result = read_mesh(as_bytes(text));
  EXPECT_FALSE(result.has_value());
  return result ? "" : result.error().message;
}

// A word that scanners and converters write in place of an unknown number, and the float that it
// means.
struct NotFinite {
  const char* text;
  float value;
};
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();
inline constexpr NotFinite kNotFinite[] = {
    {"nan", std::numeric_limits<float>::quiet_NaN()}, {"inf", kInfinity}, {"-inf", -kInfinity}};

// Expects that the reader has removed the first of four vertices. Its coordinates are not finite,
// and no face uses it.
inline void expect_first_dropped(const ImportedMesh& imported) {
  EXPECT_EQ(imported.mesh.positions, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_THAT(imported.mesh.faces, ::testing::ElementsAre(Triangle{0, 1, 2}));
  EXPECT_THAT(
      imported.repairs,
      ::testing::Contains(::testing::HasSubstr("1 point without finite coordinates dropped")));
}

// Expects that the reader refuses the file and names the first vertex. Its coordinates are not
// finite, but faces use it.
inline void expect_first_named(std::string_view file) {
  EXPECT_THAT(refusal(file), ::testing::HasSubstr(
                                 "vertex 0 (counted from 0) has a coordinate that is not a finite "
                                 "number"));
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
