// SPDX-License-Identifier: Apache-2.0
// Tables of files as real programs write them, and what each must give.
#pragma once

#include <map>

#include "codec/import/reading.h"

namespace vitrine::testing {

struct Case {
  std::string situation;
  std::string file;
  std::size_t faces = 4;
  std::vector<Colour> colours = {};  // of the vertices, in order
  std::string said = "";             // part of a line of `repairs`; empty if there is no line
  std::map<std::string, std::string> beside = {};
};

inline constexpr Colour kRedCase{255, 0, 0}, kGreenCase{0, 255, 0}, kBlueCase{0, 0, 255},
    kOchreCase{200, 200, 0}, kWhiteCase{255, 255, 255};

inline const std::vector<Colour> kFourCases{kRedCase, kGreenCase, kBlueCase, kOchreCase};

inline ImportedMesh read_case(const Case& expected) {
  Companions beside;
  for (const auto& [name, contents] : expected.beside)
    beside[name] = as_bytes(contents);
  auto result = read_mesh(as_bytes(expected.file), {.beside = beside});
  EXPECT_TRUE(result.has_value()) << result.error().message;
  return result ? *std::move(result) : ImportedMesh{};
}

inline void expect_case(const Case& expected) {
  SCOPED_TRACE(expected.situation);
  const ImportedMesh read = read_case(expected);
  EXPECT_EQ(read.mesh.faces.size(), expected.faces);
  EXPECT_EQ(read.mesh.attributes.colours, expected.colours);
  const auto said = ::testing::Contains(::testing::HasSubstr(expected.said));
  if (expected.said.empty())
    EXPECT_THAT(read.repairs, ::testing::IsEmpty());
  else
    EXPECT_THAT(read.repairs, said);
}

}  // namespace vitrine::testing
