// SPDX-License-Identifier: Apache-2.0
// Tests the errors that a scan reports if the simulated rig has a fault. Each error must name the
// fault and say what the operator should do. The tests use the real protocols.
#include "at_rig.h"

namespace vitrine::acquisition::rig::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;
using vitrine::test::ProgramResult;

const std::string kScan = "\"$vitrine\" scan --config rig.json --steps 24 -o out.ply";

using NamedErrors = AtRig;

std::string error_of(const ProgramResult& result) {
  EXPECT_EQ(result.exit_code, 1);
  return result.errors;
}

void expect_no_stripe(const std::string& error) {
  EXPECT_THAT(error,
              AllOf(StartsWith("vitrine: no stripe: "), HasSubstr("check that the laser is on")));
}

TEST_F(NamedErrors, ALaserThatDoesNotLightIsNoStripe) {
  expect_no_stripe(error_of(with_object(kScan, {"--fault", "laser-out"})));
}

// Without noise, the pictures with and without laser are equal. The error must not blame the camera
// for that.
TEST_F(NamedErrors, BeforeAnIdealCameraItIsNoStripeEither) {
  expect_no_stripe(error_of(with_object(kScan, {"--fault", "laser-out", "--ideal"})));
}

TEST_F(NamedErrors, ALaserThatGoesOutIsALostStripe) {
  EXPECT_THAT(error_of(with_object(kScan, {"--fault", "laser-out@6"})),
              AllOf(StartsWith("vitrine: the stripe is lost since step 7 of the scan, no stripe: "),
                    HasSubstr("check that the laser is on"), HasSubstr("start a new scan")));
}

// The object looks like painted bone. On such a surface, one of the two stripes is often weaker.
TEST_F(NamedErrors, TheOtherLaserMakesTwoStripes) {
  EXPECT_THAT(error_of(at_rig(kScan, {"--mesh", VITRINE_SOURCE_DIR "/tests/models/skull.obj",
                                      "--fault", "second-stripe"})),
              AllOf(StartsWith("vitrine: two stripes: "), HasSubstr("switch the other laser off")));
}

TEST_F(NamedErrors, TheOtherLaserIsNoticedAmidTheScan) {
  EXPECT_THAT(
      error_of(at_rig(kScan, {"--mesh", VITRINE_SOURCE_DIR "/tests/models/skull.obj", "--fault",
                              "second-stripe@6"})),
      AllOf(HasSubstr("of the scan, two stripes: "), HasSubstr("switch the other laser off")));
}

TEST_F(NamedErrors, LongExposureIsAllSaturated) {
  EXPECT_THAT(error_of(with_object(kScan + " --exposure 100000")),
              AllOf(StartsWith("vitrine: all saturated: "), HasSubstr("lower the exposure")));
}

TEST_F(NamedErrors, ABarePlateIsAnEmptyTurntable) {
  EXPECT_THAT(error_of(at_rig(kScan, {"--empty"})),
              AllOf(StartsWith("vitrine: empty turntable: "), HasSubstr("put an object on it")));
}

// Without the member "rig" in rig.json, the program asks an operator at the terminal to place the
// target. The test presses Enter without placing it.
TEST_F(NamedErrors, ATargetThatWasNotPutThereIsNeverSeen) {
  const std::string without_rig = "sed -zi 's/,\\s*\"rig\": {[^}]*}//' rig.json; ";
  EXPECT_THAT(error_of(with_object(without_rig + "printf '\\ndone\\n' | \"$vitrine\" calibrate "
                                                 "--config rig.json")),
              AllOf(HasSubstr("vitrine: target never seen: "), HasSubstr("light the target"),
                    HasSubstr("place it in view of the camera")));
}

}  // namespace
}  // namespace vitrine::acquisition::rig::test
