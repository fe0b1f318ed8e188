// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <sstream>

#include "codec/core/vec.h"
#include "support/product_names.h"
#include "vitrine_command.h"

namespace vitrine::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::StartsWith;

// Returns the PLY with each vertex replaced by other(vertex).
std::string with_vertices(const std::string& ply, Vec3 (*other)(const Vec3&)) {
  const std::size_t header = ply.find("end_header\n") + 11;
  std::istringstream in(ply.substr(header));
  std::ostringstream out;
  out.precision(9);
  out << ply.substr(0, header);
  for (std::string line; std::getline(in, line);) {
    Vec3 p;
    std::istringstream words(line);
    const bool is_vertex = line.find('.') != std::string::npos && words >> p.x >> p.y >> p.z;
    if (is_vertex) {
      const Vec3 q = other(p);
      out << q.x << " " << q.y << " " << q.z << "\n";
    } else {
      out << line << "\n";
    }
  }
  return out.str();
}

// Rotates by 180 degrees about x and shifts by 2 along y.
Vec3 turned_over(const Vec3& p) {
  return {p.x, 2 - p.y, -p.z};
}

Vec3 enlarged(const Vec3& p) {
  return p * 1.3;
}

class Merge : public VitrineCommand {
 protected:
  Merge() {
    const std::string ply = bumpy_ply(3'000);
    write("a.ply", ply), write("b.ply", with_vertices(ply, turned_over));
  }

  // Returns the arguments of a merge. The default start is rough: 2 degrees and 0.1 mm off.
  std::vector<std::string> words(const std::string& start =
                                     R"({"axis": {"x": 1}, "degrees": -178,
                                         "shift": {"x": 0.1, "y": 2}})") const {
    const std::string starts = write("starts.json", R"({"starts": [)" + start + "]}");
    return {"merge",     path("a.ply"), path("b.ply"), "--starts",     starts,
            "--overlap", "0.1",         "-o",          path("out.ply")};
  }
};

TEST_F(Merge, AScanOfTheObjectInAnotherPoseIsMovedOntoTheFirst) {
  const json merged = vitrine_json(words());
  EXPECT_EQ(merged["faces"], 2'888);  // the second scan adds no surface
  ASSERT_EQ(merged["scans"].size(), 2u);
  EXPECT_EQ(merged["scans"][1]["file"], path("b.ply"));
  EXPECT_LT(merged["scans"][1]["rms"].get<double>(), 1e-3);
  EXPECT_NEAR(merged["scans"][1]["shift"][1].get<double>(), 2, 1e-3);
  EXPECT_NEAR(merged["scans"][1]["rotation"][1][1].get<double>(), -1, 1e-3);
  const ProgramResult said = vitrine(words());
  EXPECT_THAT(said.output, HasSubstr("b.ply: rms 0.000"));
  EXPECT_THAT(said.output, HasSubstr("where 100 % of it overlaps"));
  EXPECT_EQ(merged["scans"][1]["doubtful"], false);
  // Does not call vitrine_json(), since the command also prints a note: a.ply states no unit.
  const ProgramResult measured = vitrine({"measure", path("out.ply"), path("a.ply"), "--json"});
  EXPECT_LT(json::parse(measured.output)["rms"].get<double>(), 1e-3);
}

TEST_F(Merge, AScanThatMayBeMisalignedIsNoted) {
  write("b.ply", with_vertices(read("a.ply"), enlarged));  // b.ply is a scan of a different object
  auto line = words("{}");
  line.emplace_back("--json");
  const ProgramResult result = vitrine(line);
  expect_fault(result, 0);  // a note has the same form as an error
  EXPECT_THAT(result.errors, StartsWith("vitrine: note: " + path("b.ply") + " may be misaligned"));
  EXPECT_EQ(json::parse(result.output)["scans"][1]["doubtful"], true);
  EXPECT_TRUE(std::filesystem::exists(path("out.ply")));
}

TEST_F(Merge, AStartThatIsFarOffIsRefusedAndNothingIsWritten) {
  const ProgramResult result = vitrine(words(R"({"shift": {"x": 500}})"));
  expect_fault(result, 1);
  EXPECT_THAT(result.errors, HasSubstr("scan 2 overlaps"));
  EXPECT_FALSE(std::filesystem::exists(path("out.ply")));
}

TEST_F(Merge, EachScanButTheFirstNeedsAStart) {
  const ProgramResult result = vitrine(words("{}, {}"));
  expect_fault(result, 1);
  EXPECT_THAT(result.errors, HasSubstr("starts.json has 2 starts for 2 scans; give 1"));
}

TEST_F(Merge, WrongUsageIsReportedAndNoInputIsReplaced) {
  auto line = words();
  line.back() = path("b.ply");
  const std::string before = read("b.ply");
  expect_fault(vitrine(line), 1);
  EXPECT_EQ(read("b.ply"), before);
  line.back() = path("out.xyz");
  EXPECT_EQ(vitrine(line).exit_code, 2);
  EXPECT_EQ(vitrine({"merge", path("a.ply"), "--starts", "s", "-o", path("out.ply")}).exit_code, 2);
  EXPECT_EQ(vitrine({"merge", path("a.ply"), path("b.ply"), "-o", path("out.ply")}).exit_code, 2);
}

}  // namespace
}  // namespace vitrine::test
