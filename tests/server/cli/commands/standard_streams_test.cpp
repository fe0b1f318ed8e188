// SPDX-License-Identifier: Apache-2.0
// Tests "-" as a file name for standard input and standard output, in pipes of a shell.
#include <gmock/gmock.h>

#include "support/product_names.h"
#include "vitrine_command.h"

namespace vitrine::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class StandardStreams : public VitrineCommand {
 protected:
  // Runs a script in the test's folder. In the script, $vitrine is the program.
  ProgramResult shell(const std::string& script) const {
    return run_program({"sh", "-c", "cd \"$0\" || exit; vitrine=\"$1\"; " + script,
                        folder_.path().string(), kVitrine});
  }
};

TEST_F(StandardStreams, AModelBuiltInAPipeIsTheModelBuiltFromTheFile) {
  const std::string file = read(std::filesystem::path(model()).filename().string());
  for (const std::string input :
       {"cat model.ply | \"$vitrine\" build -", "\"$vitrine\" build - < model.ply"}) {
    const ProgramResult piped = shell(input + " -o -");
    EXPECT_EQ(piped.exit_code, 0) << piped.errors;
    EXPECT_TRUE(piped.output == file) << input;
    EXPECT_THAT(piped.errors, HasSubstr("bits per vertex"));
  }
}

TEST_F(StandardStreams, AMeshIsDecodedInAPipe) {
  vitrine_json({"decode", model(), "-o", path("mesh.ply"), "--level", "1"});
  const ProgramResult piped = shell(
      "\"$vitrine\" build - -o - < model.ply 2> log | "
      "\"$vitrine\" decode - -o - --format ply --level 1 --json");
  EXPECT_EQ(piped.exit_code, 0) << piped.errors;
  EXPECT_TRUE(piped.output == read("mesh.ply"));
  EXPECT_GT(nlohmann::json::parse(piped.errors)["faces"], 0);
}

TEST_F(StandardStreams, AFaultLeavesStandardOutputEmpty) {
  write("model.ply", bumpy_ply(3'000));
  const ProgramResult cut = shell("head -c 20000 model.ply | \"$vitrine\" build - -o -");
  expect_fault(cut, 1);
  EXPECT_THAT(cut.errors, StartsWith("vitrine: standard input: "));
  EXPECT_EQ(cut.output, "");
  const ProgramResult empty = shell("\"$vitrine\" build - -o - < /dev/null");
  expect_fault(empty, 1);
  EXPECT_THAT(empty.errors, HasSubstr("standard input is empty"));
}

TEST_F(StandardStreams, AFullDiskBehindStandardOutputIsAFault) {
  const ProgramResult full =
      shell("\"$vitrine\" decode " + model() + " -o - --format ply > /dev/full");
  expect_fault(full, 1);
  EXPECT_THAT(full.errors, HasSubstr("cannot write the result to stdout"));
}

TEST_F(StandardStreams, TheFormatOfTheInputIsCheckedOnRequest) {
  write("model.ply", bumpy_ply(3'000));
  EXPECT_EQ(shell("\"$vitrine\" build - --format ply -o - < model.ply").exit_code, 0);
  const ProgramResult other = shell("\"$vitrine\" build - --format obj -o - < model.ply");
  expect_fault(other, 1);
  EXPECT_THAT(other.errors, HasSubstr("standard input: this is not OBJ, as --format says"));
  EXPECT_EQ(shell("\"$vitrine\" build - --format xyz -o - < model.ply").exit_code, 2);
}

TEST_F(StandardStreams, WrongUsageIsExitCode2) {
  const std::string file = model();
  expect_fault(vitrine({"decode", file, "-o", "-"}), 2);
  expect_fault(vitrine({"decode", file, "-o", "-", "--format", "pmesh"}), 2);
  expect_fault(vitrine({"decode", file, "-o", path("out.ply"), "--format", "ply"}), 2);
  expect_fault(vitrine({"build", path("model.ply"), "-o", path("out.pmesh"), "--report", "-"}), 2);
  EXPECT_EQ(files(), (std::vector<std::string>{"model.ply", "model.pmesh"}));
}

}  // namespace
}  // namespace vitrine::test
