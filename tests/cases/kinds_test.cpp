// SPDX-License-Identifier: Apache-2.0
// Reads all inputs of all kinds, and compares the kinds with the table in README.md.
#include <fstream>
#include <set>

#include "cases/kind.h"

namespace vitrine {
namespace {

using vitrine::testing::Case;
using vitrine::testing::FileKind;

std::vector<FileKind> all_kinds() {
  std::vector<FileKind> kinds;
  for (const auto& of_format : {testing::obj_kinds(), testing::stl_kinds(), testing::ply_kinds(),
                                testing::off_kinds(), testing::glb_kinds()})
    kinds.insert(kinds.end(), of_format.begin(), of_format.end());
  return kinds;
}

// Returns the names in the first column of the table in README.md.
std::multiset<std::string> names_in_the_table() {
  std::ifstream file(VITRINE_SOURCE_DIR "/tests/cases/README.md");
  std::multiset<std::string> names;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("| `")) names.insert(line.substr(3, line.find('`', 3) - 3));
  }
  return names;
}

TEST(Kinds, AreThoseOfTheTable) {
  std::multiset<std::string> names;
  for (const FileKind& kind : all_kinds())
    names.insert(kind.name);
  EXPECT_EQ(names, names_in_the_table());
  EXPECT_EQ(names.size(), 37u);
}

TEST(Kinds, HaveAtLeastThreeDifferentInputs) {
  for (const FileKind& kind : all_kinds()) {
    std::set<std::pair<std::string, std::map<std::string, std::string>>> inputs;
    for (const Case& input : kind.inputs)
      inputs.emplace(input.file, input.beside);
    EXPECT_EQ(inputs.size(), kind.inputs.size()) << kind.name << " has an input twice";
    EXPECT_GE(inputs.size(), 3u) << kind.name;
  }
}

TEST(Kinds, GiveTheExpectedResults) {
  for (const FileKind& kind : all_kinds()) {
    SCOPED_TRACE(kind.name);
    for (const Case& input : kind.inputs)
      expect_case(input);
  }
}

}  // namespace
}  // namespace vitrine
