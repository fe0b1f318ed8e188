// SPDX-License-Identifier: Apache-2.0
// Kinds of mesh files that users have. Each kind has inputs with their expected results.
#pragma once

#include <map>
#include <optional>

#include "codec/import/reading.h"

namespace vitrine::testing {

// A file as a real program writes it, with the expected result of reading it.
struct Case {
  std::string situation;
  std::string file;
  std::size_t faces = 4;
  std::vector<Colour> colours = {};  // expected vertex colours, in order
  std::string said = "";             // expected part of a `repairs` line; no line expected if empty
  std::map<std::string, std::string> beside = {};
  std::vector<Triangle> triangles = {};  // expected faces, in order; not checked if empty
  std::vector<Vec3> positions = {};      // expected positions, in order; not checked if empty
  std::optional<std::string> unit = {};  // expected unit; not checked if nullopt
  std::string refused = "";              // expected part of the error; empty if there is none
};

// `name` is the kind's name in the table of README.md.
struct FileKind {
  std::string name;
  std::vector<Case> inputs;
};

// The kinds of each format.
std::vector<FileKind> glb_kinds();
std::vector<FileKind> obj_kinds();
std::vector<FileKind> off_kinds();
std::vector<FileKind> ply_kinds();
std::vector<FileKind> stl_kinds();

inline constexpr Colour kRedCase{255, 0, 0}, kGreenCase{0, 255, 0}, kBlueCase{0, 0, 255},
    kOchreCase{200, 200, 0}, kWhiteCase{255, 255, 255};

inline const std::vector<Colour> kFourCases{kRedCase, kGreenCase, kBlueCase, kOchreCase};

inline Expected<ImportedMesh> try_case(const Case& expected) {
  Companions beside;
  for (const auto& [name, contents] : expected.beside)
    beside[name] = as_bytes(contents);
  return read_mesh(as_bytes(expected.file), {.beside = beside});
}

inline ImportedMesh read_case(const Case& expected) {
  auto result = try_case(expected);
  EXPECT_TRUE(result.has_value()) << result.error().message;
  if (result) expect_counts_and_steps(result->repairs);
  return result ? *std::move(result) : ImportedMesh{};
}

inline void expect_refused(const Case& expected) {
  const auto result = try_case(expected);
  ASSERT_FALSE(result.has_value());
  EXPECT_THAT(result.error().message, ::testing::HasSubstr(expected.refused));
}

inline void expect_case(const Case& expected) {
  SCOPED_TRACE(expected.situation);
  if (!expected.refused.empty()) return expect_refused(expected);
  const ImportedMesh read = read_case(expected);
  EXPECT_EQ(read.mesh.faces.size(), expected.faces);
  EXPECT_EQ(read.mesh.attributes.colours, expected.colours);
  if (!expected.triangles.empty()) {
    EXPECT_EQ(read.mesh.faces, expected.triangles);
  }
  if (!expected.positions.empty()) {
    EXPECT_EQ(read.mesh.positions, expected.positions);
  }
  if (expected.unit) {
    EXPECT_EQ(read.unit, *expected.unit);
  }
  const auto said = ::testing::Contains(::testing::HasSubstr(expected.said));
  if (expected.said.empty())
    EXPECT_THAT(read.repairs, ::testing::IsEmpty());
  else
    EXPECT_THAT(read.repairs, said);
}

}  // namespace vitrine::testing
