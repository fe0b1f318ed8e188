// SPDX-License-Identifier: Apache-2.0
#include "acquisition/rig/stage.h"

namespace vitrine::rig {

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
  setting_.laser = on;
}

void Stage::motor(bool on) {
  const std::lock_guard lock(mutex_);
  setting_.motor = on;
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

}  // namespace vitrine::rig
