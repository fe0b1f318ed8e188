// SPDX-License-Identifier: Apache-2.0
// Tests `vitrine fuse` with several scans of one object. The simulated scanner made each scan in
// another pose of the object.
#include <gmock/gmock.h>

#include "vitrine_command.h"

namespace vitrine::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class FuseAtRig : public VitrineCommand {
 protected:
  // Scans `mesh`, turned so that its axis `up` points upwards. `height` is its height along that
  // axis, in mm.
  void scan(const std::string& mesh, const std::string& up, const std::string& height,
            const std::string& name) {
    const ProgramResult result = run_program(
        {VITRINE_BIN_DIR "/vitrine-rig",
         "--mesh",
         mesh,
         "--up",
         up,
         "--height-mm",
         height,
         "--steps",
         "180",
         "--private-network",
         "--write-config",
         path("rig.json"),
         "--write-truth",
         path(name + ".truth.ply"),
         "--",
         "sh",
         "-c",
         "cd \"$0\" || exit; [ -d calibrations ] || \"$1\" calibrate --config rig.json && \"$1\" "
         "scan --config rig.json --keep -o " +
             name + ".ply",
         folder_.path().string(),
         kVitrine});
    ASSERT_EQ(result.exit_code, 0) << result.errors;
  }
  std::vector<std::string> words(const std::vector<std::string>& names) const {
    std::vector<std::string> all = {"fuse", "--config", path("rig.json"), "-o", path("out.ply")};
    for (const std::string& name : names)
      all.push_back(path(name + ".ply.scan"));
    return all;
  }
};

TEST_F(FuseAtRig, TheHeadStandingAndUpsideDownBecomesOneSurface) {
  const std::string head = VITRINE_SOURCE_DIR "/tests/models/demosthenes.obj";
  scan(head, "y", "80", "standing");
  scan(head, "-y", "80", "over");
  const json fused = vitrine_json(words({"standing", "over"}));
  ASSERT_EQ(fused["pairs"].size(), 1U);
  EXPECT_LT(fused["pairs"][0]["crossed"].get<double>(), .03);
  EXPECT_LT(fused["pairs"][0]["rms"].get<double>(), .15);
  const auto off = [&](const std::string& file) {
    return vitrine_json({"measure", path(file), path("standing.truth.ply"), "--align"});
  };
  const json one = off("standing.ply"), both = off("out.ply");
  EXPECT_LT(both["a_to_b"]["rms"].get<double>(), .2);
  // The second scan shows parts of the surface that the first scan does not show.
  EXPECT_LT(both["b_to_a"]["rms"].get<double>(), one["b_to_a"]["rms"].get<double>());
}

// For a body of revolution, nobody can determine the rotation about its axis between two scans.
TEST_F(FuseAtRig, ASymmetricObjectIsRefusedAndNothingIsWritten) {
  std::string ply;
  constexpr int kAround = 60, kRows = 40;
  for (int j = 0; j < kRows; ++j) {
    for (int i = 0; i < kAround; ++i) {
      const double y = 2. * j / (kRows - 1), a = 2 * M_PI * i / kAround;
      const double r = (j == 0 || j == kRows - 1 ? 0 : .5 + .15 * std::sin(3 * y));
      ply += std::to_string(r * std::cos(a)) + " " + std::to_string(y) + " " +
             std::to_string(r * std::sin(a)) + "\n";
    }
  }
  for (int j = 0; j + 1 < kRows; ++j) {
    for (int i = 0; i < kAround; ++i) {
      const int a = j * kAround + i, b = j * kAround + (i + 1) % kAround;
      for (const auto& [p, q, r] : {std::tuple{a, a + kAround, b}, {b, a + kAround, b + kAround}})
        ply += "3 " + std::to_string(p) + " " + std::to_string(q) + " " + std::to_string(r) + "\n";
    }
  }
  write("vase.ply", "ply\nformat ascii 1.0\nelement vertex " + std::to_string(kAround * kRows) +
                        "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                        std::to_string(2 * kAround * (kRows - 1)) +
                        "\nproperty list uchar int vertex_indices\nend_header\n" + ply);
  scan(path("vase.ply"), "y", "60", "standing");
  scan(path("vase.ply"), "-y", "60", "over");
  const ProgramResult result = vitrine(words({"standing", "over"}));
  expect_fault(result, 1);
  EXPECT_THAT(result.errors, HasSubstr("fit together in more than one way"));
  EXPECT_FALSE(std::filesystem::exists(path("out.ply")));
}

TEST_F(FuseAtRig, WrongUsageIsReported) {
  EXPECT_EQ(vitrine({"fuse", "a", "b", "-o", path("out.ply")}).exit_code, 2);
  EXPECT_EQ(vitrine({"fuse", "a", "--config", "r", "-o", path("out.ply")}).exit_code, 2);
}

}  // namespace
}  // namespace vitrine::test
