// SPDX-License-Identifier: Apache-2.0
#include "acquisition/rig_optics/stage.h"

namespace vitrine::acquisition::rig {

void Stage::passes(double degrees) {
  const std::lock_guard lock(mutex_);
  setting_.degrees = degrees;
}

void Stage::turned_to(double degrees) {
  int turns = 0;
  {
    const std::lock_guard lock(mutex_);
    setting_.degrees = degrees;
    turns = ++setting_.turns;
  }
  if (on_turn_) on_turn_(turns);
}

void Stage::laser(bool on) {
  const std::lock_guard lock(mutex_);
  setting_.is_laser_on = on;
}

void Stage::motor(bool on) {
  const std::lock_guard lock(mutex_);
  setting_.is_motor_on = on;
}

void Stage::place_object() {
  const std::lock_guard lock(mutex_);
  setting_.target.reset();
}

void Stage::place_target(int pose) {
  const std::lock_guard lock(mutex_);
  setting_.target = pose;
}

Setting Stage::now() const {
  const std::lock_guard lock(mutex_);
  return setting_;
}

}  // namespace vitrine::acquisition::rig
