// SPDX-License-Identifier: Apache-2.0
// Tests builds with all combinations of some options. Also tests that the error which a refused
// export suggests is accepted.
#include <set>

#include "support/product_names.h"
#include "vitrine_command.h"

namespace vitrine::test {
namespace {

TEST_F(VitrineCommand, OpenAndColouredModelsAreLosslessWithBothPlacementsAndOrders) {
  const std::string in = write("in.ply", bumpy_ply(2'500, true, true));
  std::set<std::string> files;
  for (const std::string placement : {"midpoint", "pyramid"}) {
    for (const std::string order : {"batch", "heap"}) {
      for (const std::string bits : {"10", "16"}) {
        vitrine_json({"build", in, "-o", path("out.pmesh"), "--placement", placement, "--order",
                      order, "--bits", bits});
        EXPECT_EQ(vitrine_json({"verify", path("out.pmesh"), "--against", in})["lossless"], true)
            << placement << ' ' << order << ' ' << bits;
        files.insert(read("out.pmesh"));
      }
    }
  }
  EXPECT_EQ(files.size(), 8u) << "an option had no effect";
}

TEST_F(VitrineCommand, TheErrorThatARefusalNamesIsAccepted) {
  static const std::regex kNamed("an error of ([^;]+);");
  for (const int faces : {500, 700, 1'100, 1'500}) {
    const std::string file = model(faces);
    const ProgramResult refused = vitrine({"decode", file, "-o", path("out.ply"), "--error", "0"});
    std::smatch named;
    ASSERT_TRUE(std::regex_search(refused.errors, named, kNamed)) << refused.errors;
    vitrine_json({"decode", file, "-o", path("out.ply"), "--error", named[1]});
    EXPECT_NE(vitrine({"info", file}).output.find(" " + named[1].str() + " "), std::string::npos);
  }
}

}  // namespace
}  // namespace vitrine::test
