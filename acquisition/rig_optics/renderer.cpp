// SPDX-License-Identifier: Apache-2.0
#include "acquisition/rig_optics/renderer.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "acquisition/rig_optics/noise.h"

namespace vitrine::acquisition::rig {
namespace {

constexpr double kMotorError = 0.05;  // standard deviation of the motor's error, in degrees
constexpr std::size_t kPixels = static_cast<std::size_t>(kSensorWidth) * kSensorHeight;

// Returns the angle, reduced to one revolution, in millionths of a degree.
std::uint64_t within_turn(double degrees) {
  constexpr std::int64_t kTurn = 360'000'000;
  const std::int64_t rest = std::llround(degrees * 1e6) % kTurn;
  return static_cast<std::uint64_t>(rest < 0 ? rest + kTurn : rest);
}

}  // namespace

double reached(const Realism& realism, double degrees) {
  if (realism.is_ideal) return degrees;
  const std::uint64_t key = key_of(realism.seed, 0x30704, within_turn(degrees));
  return degrees + kMotorError * static_cast<double>(normal(key, 0));
}

Renderer::Renderer(const Optics& optics, const Subject* object, const Realism& realism)
    : optics_(optics),
      object_(object),
      realism_(realism),
      rays_(optics.camera),
      poses_(target_poses(realism.seed)) {
  if (realism_.is_ideal) realism_.look.speckle = 0;
}

std::uint64_t Renderer::scene_key(const Setting& setting) const {
  const auto pose = static_cast<std::uint64_t>(setting.target ? 1 + *setting.target : 0);
  return key_of(realism_.seed, within_turn(setting.degrees), pose);
}

void Renderer::light_up(const Shot& shot, const LitScene& scene) {
  const double degrees = reached(realism_, shot.setting.degrees);
  const Subject* subject = object_;
  SubjectFrame frame = on_table(optics_, degrees);
  if (shot.setting.target) {
    if (!target_) target_.emplace();
    subject = &*target_;
    const TargetPose& pose = poses_.at(static_cast<std::size_t>(*shot.setting.target));
    frame = pose.stands_on_table ? on_table(optics_, degrees, pose.frame) : pose.frame;
  }
  if (!subject) {
    light_ = {std::vector<float>(kPixels, kBackground), std::vector<float>(kPixels)};
    return;
  }
  Optics optics = optics_;
  optics.laser.offset += shot.laser_shift;
  const LocalOptics local = optics_in(frame, optics);
  light_ = {ambient_light(local, rays_, *subject),
            stripe_light(local, rays_, *subject, realism_.look, key_of(scene.key, 0x59ec))};
  if (!scene.has_second_stripe) return;
  optics.laser = other_laser(optics_);
  const std::vector<float> second = stripe_light(optics_in(frame, optics), rays_, *subject,
                                                 realism_.look, key_of(scene.key, 0x59ed));
  std::ranges::transform(light_.laser, second, light_.laser.begin(), std::plus<>());
}

Frame Renderer::take(const Shot& shot) {
  const LitScene scene{scene_key(shot.setting), shot.laser_shift, shot.has_second_stripe};
  if (lit_ != scene) {
    light_up(shot, scene);
    lit_ = scene;
  }
  const std::uint64_t noise =
      realism_.is_ideal ? 0 : key_of(scene.key, 1 + shot.setting.is_laser_on);
  const bool lit = shot.setting.is_laser_on && !shot.is_laser_out;
  return expose(light_, lit, shot.exposure, noise, shot.region);
}

}  // namespace vitrine::acquisition::rig
