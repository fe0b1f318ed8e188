// SPDX-License-Identifier: Apache-2.0
// What a scan cannot be made of: shown by the simulated rig, met by vitrine over the real
// protocols, and told to the operator by name and with what to do.
#include "at_rig.h"

namespace vitrine::rig::test {
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

// Its pictures with and without laser are equal, and no fault of the camera.
TEST_F(NamedErrors, BeforeAnIdealCameraItIsNoStripeEither) {
  expect_no_stripe(error_of(with_object(kScan, {"--fault", "laser-out", "--ideal"})));
}

TEST_F(NamedErrors, ALaserThatGoesOutIsALostStripe) {
  EXPECT_THAT(error_of(with_object(kScan, {"--fault", "laser-out@6"})),
              AllOf(StartsWith("vitrine: the stripe is lost since step 7 of the scan, no stripe: "),
                    HasSubstr("check that the laser is on"), HasSubstr("start a new scan")));
}

// On painted bone, where one of them is often weaker.
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

// Of a rig without a door the terminal asks the operator, who only presses Enter.
TEST_F(NamedErrors, ATargetThatWasNotPutThereIsNeverSeen) {
  const std::string close_door = "sed -zi 's/,\\s*\"rig\": {[^}]*}//' rig.json; ";
  EXPECT_THAT(error_of(with_object(close_door + "printf '\\ndone\\n' | \"$vitrine\" calibrate "
                                                "--config rig.json")),
              AllOf(HasSubstr("vitrine: target never seen: "), HasSubstr("light the target"),
                    HasSubstr("place it in view of the camera")));
}

}  // namespace
}  // namespace vitrine::rig::test
