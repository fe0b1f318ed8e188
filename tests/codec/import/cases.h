// SPDX-License-Identifier: Apache-2.0
// The type of a test case: a file as a real program writes it, with the expected result of reading
// it. The tests *_cases_test.cpp have tables of such cases.
#pragma once

#include <map>

#include "codec/import/reading.h"

namespace vitrine::testing {

struct Case {
  std::string situation;
  std::string file;
  std::size_t faces = 4;
  std::vector<Colour> colours = {};  // expected vertex colours, in order
  std::string said = "";             // expected part of a `repairs` line; empty for no line
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
