// SPDX-License-Identifier: Apache-2.0
#include "acquisition/rig/stage.h"

namespace vitrine::rig {

bool Stage::turn_to(double degrees) {
  int turns = 0;
  {
    const std::lock_guard lock(mutex_);
    turns = ++setting_.turns;
  }
  if (on_turn_ && !on_turn_(turns)) return false;
  const std::lock_guard lock(mutex_);
  setting_.degrees = degrees;
  return true;
}

void Stage::laser(bool on) {
  const std::lock_guard lock(mutex_);
  setting_.laser = on;
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
