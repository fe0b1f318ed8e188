// SPDX-License-Identifier: Apache-2.0
#include "simulated_scanner.h"

#include "acquisition/profile/profile_of.h"
#include "acquisition/rig_optics/target.h"
#include "acquisition/session/target_pictures.h"
#include "support/product_names.h"
#include "value_of.h"

namespace vitrine::bench {
namespace {

class RigCamera final : public Camera {
 public:
  RigCamera(rig::Renderer& renderer, const rig::Stage& stage)
      : renderer_(renderer), stage_(stage) {}

  const CameraIdentity& identity() const override { return identity_; }
  SensorRegion region() const override { return rig::kWholeSensor; }
  Expected<void> configure(const CameraSettings& settings) override {
    exposure_ = {settings.exposure_us, settings.gain_db};
    return {};
  }
  Expected<Frame> capture() override {
    return renderer_.take({.setting = stage_.now(), .exposure = exposure_});
  }

 private:
  const CameraIdentity identity_{"Vitrine", "rig", "bench"};
  rig::Renderer& renderer_;
  const rig::Stage& stage_;
  rig::Exposure exposure_;
};

class RigBoard final : public Board {
 public:
  explicit RigBoard(rig::Stage& stage) : stage_(stage) {}
  ~RigBoard() override { stage_.laser(false); }

  const BoardIdentity& identity() const override { return identity_; }
  Expected<std::optional<double>> position() override { return stage_.now().degrees; }
  Expected<void> set_position(double) override { return {}; }
  Expected<void> turn_to(double degrees) override { return stage_.turned_to(degrees), Ok(); }
  Expected<void> laser(bool on) override { return stage_.laser(on), Ok(); }
  Expected<void> rest() override { return laser(false); }
  void emergency_stop() noexcept override {}

 private:
  using Ok = Expected<void>;
  const BoardIdentity identity_{"rig", "", "bench"};
  rig::Stage& stage_;
};

CharucoTarget target() {
  const rig::TargetSpec spec;
  return {spec.squares_x, spec.squares_y, spec.square_mm, spec.marker_mm, rig::kTargetDictionary};
}

}  // namespace

std::vector<Profile> profiles_of(const std::vector<StripeAt>& stripes,
                                 const Calibration& calibration, int every) {
  std::vector<Profile> profiles;
  for (std::size_t i = 0; i < stripes.size(); i += static_cast<std::size_t>(every))
    profiles.push_back(profile_of(stripes[i].points, calibration, stripes[i].angle));
  return profiles;
}

SimulatedScanner::SimulatedScanner(const TriangleMesh& object, const rig::Realism& realism)
    : solid_(object), renderer_(rig::optics_of(realism.seed), &solid_, realism) {}

CalibrationInput SimulatedScanner::picture_target() {
  Scanner scanner;
  scanner.devices.open_camera = [&]() -> Expected<std::unique_ptr<Camera>> {
    return std::make_unique<RigCamera>(renderer_, stage_);
  };
  scanner.devices.open_board = [&]() -> Expected<std::unique_ptr<Board>> {
    return std::make_unique<RigBoard>(stage_);
  };
  const PlaceTarget place = [&](int number) -> Expected<bool> {
    if (number >= rig::kHeldPoses + rig::kTablePoses) return false;
    return stage_.place_target(number), true;
  };
  EmergencyStop stop;
  auto input = value_of(vitrine::acquisition::picture_target(scanner, target(), place, stop));
  stage_.place_object();
  return input;
}

FramePair SimulatedScanner::pictures(double angle, double exposure_us) {
  const auto take = [&](bool laser) {
    return renderer_.take(
        {.setting = {.degrees = angle, .is_laser_on = laser}, .exposure = {.us = exposure_us}});
  };
  Frame dark = take(false);
  return {std::move(dark), take(true)};
}

std::vector<StripeAt> SimulatedScanner::scan(int steps, double exposure_us) {
  std::vector<StripeAt> stripes;
  for (int step = 0; step < steps; ++step) {
    const double angle = 360.0 * step / steps;
    const FramePair frames = pictures(angle, exposure_us);
    stripes.push_back({angle, value_of(find_stripe(frames.lit, frames.dark))});
  }
  return stripes;
}

Calibration calibration_of(const CalibrationInput& input, int degree) {
  return value_of(calibrate(input, {.degree = degree})).calibration;
}

}  // namespace vitrine::bench
