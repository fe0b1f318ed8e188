// SPDX-License-Identifier: Apache-2.0
// Tests the page that `vitrine build --report` writes.
#include <gmock/gmock.h>

#include "support/product_names.h"
#include "vitrine_command.h"

namespace vitrine::test {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class ReportCommand : public VitrineCommand {
 protected:
  // Builds `in` with a report and checks that the report is well-formed. Returns its content.
  json report_of(const std::string& in) {
    vitrine_json({"build", in, "-o", path("out.pmesh"), "--report", path("out.html")});
    const ProgramResult result =
        run_program({"python3", VITRINE_SOURCE_DIR "/tests/server/cli/commands/read_report.py",
                     path("out.html")});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return json::parse(result.output, nullptr, false);
  }
};

TEST_F(ReportCommand, ItsFiguresAreThoseOfInfo) {
  const json page = report_of(write("in.ply", bumpy_ply(3'000)));
  const json levels = vitrine_json({"info", path("out.pmesh")})["levels"];
  ASSERT_EQ(page["levels"].size(), levels.size());
  double before = 0;
  for (std::size_t l = 0; l < levels.size(); ++l) {
    const json &row = page["levels"][l], &level = levels[l];
    const double bytes = level["cumulative_bytes"];
    const json expected = {static_cast<double>(l),
                           level["faces"].get<double>(),
                           level["vertices"].get<double>(),
                           bytes - before,
                           bytes,
                           8 * bytes / level["vertices"].get<double>(),
                           level["rms_error"],
                           level["max_error"]};
    EXPECT_EQ(row, expected) << l;
    before = bytes;
  }
}

TEST_F(ReportCommand, ItHasAPlotAndFivePicturesAndFetchesNothing) {
  const json page = report_of(write("in.ply", bumpy_ply(12'000)));
  const std::size_t levels = page["levels"].size();
  EXPECT_GT(page["marks"].get<std::size_t>(),
            2 * levels);  // the plot also has marks for single files, as a comparison
  EXPECT_EQ(page["pictures"], json(std::vector<std::string>(5, "data:image/png;base64,")));
  EXPECT_EQ(page["links"], json::array());
  EXPECT_EQ(page["scripts"], json::array());
  const std::string text = read("out.html");
  for (const char* outside : {"http:", "https:", "url(", "@import", "//www"})
    EXPECT_THAT(text, Not(HasSubstr(outside)));
}

TEST_F(ReportCommand, ItStatesTheInputAndItsRepairs) {
  std::string ply = bumpy_ply(500);
  const std::size_t face = ply.find("\n3 ", ply.find("end_header")) + 1;
  const std::string line = ply.substr(face, ply.find('\n', face) - face + 1);
  ply.replace(ply.find("element face 450"), 16, "element face 451");
  const std::string in = write("in.ply", ply + line);  // the file contains one face twice
  const json page = report_of(in);
  const json built = vitrine_json({"build", in, "-o", path("out.pmesh")});
  EXPECT_THAT(page["text"].get<std::string>(),
              HasSubstr(built["input"]["repairs"][0].get<std::string>()));
  EXPECT_THAT(page["text"].get<std::string>(), HasSubstr("pmesh 1.0"));
}

TEST_F(ReportCommand, AHostileNameIsOnlyText) {
  const std::string name = "<script>alert('&\"')<\xFF\x01.ply";
  const json page = report_of(write(name, bumpy_ply(500)));
  const std::string shown = "<script>alert('&\"')<\xEF\xBF\xBD\xEF\xBF\xBD.ply";
  EXPECT_EQ(page["title"], shown);
  EXPECT_EQ(page["heading"], shown);
  EXPECT_EQ(page["scripts"], json::array());
}

TEST_F(ReportCommand, AModelOfOneLevelHasAPage) {
  const json page = report_of(
      write("in.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"));
  EXPECT_EQ(page["levels"].size(), 1u);
  EXPECT_EQ(page["pictures"].size(), 1u);
}

TEST_F(ReportCommand, APageThatCannotBeWrittenIsRefusedBeforeTheBuild) {
  const std::string in = write("in.ply", bumpy_ply(500));
  const ProgramResult absent =
      vitrine({"build", in, "-o", path("out.pmesh"), "--report", path("absent/out.html")});
  expect_fault(absent, 1);
  EXPECT_THAT(absent.errors, HasSubstr("create the folder"));
  std::filesystem::create_directory(path("folder.html"));
  expect_fault(vitrine({"build", in, "-o", path("out.pmesh"), "--report", path("folder.html")}), 1);
  EXPECT_THAT(files(), ElementsAre("folder.html", "in.ply"));
}

TEST_F(ReportCommand, ThePageReplacesNeitherTheInputNorTheModel) {
  const std::string mesh = bumpy_ply(500), in = write("in.ply", mesh);
  expect_fault(vitrine({"build", in, "-o", path("out.pmesh"), "--report", path("./in.ply")}), 1);
  expect_fault(vitrine({"build", in, "-o", path("out.pmesh"), "--report", path("./out.pmesh")}), 2);
  EXPECT_EQ(read("in.ply"), mesh);
  EXPECT_THAT(files(), ElementsAre("in.ply"));
}

TEST_F(ReportCommand, AnOlderPageSurvivesAFailure) {
  const std::string page = write("out.html", "precious");
  const std::string in = write("in.ply", "ply\n");
  expect_fault(vitrine({"build", in, "-o", path("out.pmesh"), "--report", page}), 1);
  EXPECT_EQ(read("out.html"), "precious");
}

}  // namespace
}  // namespace vitrine::test
