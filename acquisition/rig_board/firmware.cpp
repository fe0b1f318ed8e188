// SPDX-License-Identifier: Apache-2.0
#include "acquisition/rig_board/firmware.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace vitrine::acquisition::rig {

void Firmware::restart(double now) {
  stop_moving(now);
  is_stalled_ = is_laser_on_ = is_motor_on_ = false;
  output_.clear();
  forget();
}

void Firmware::receive(std::string_view bytes, double now) {
  advance(now);
  for (const char byte : bytes) {
    take(byte, now);
    advance(now);
  }
}

void Firmware::advance(double now) {
  while (now >= next()) {
    table_ += std::exchange(motion_, std::nullopt)->steps;
    completed(now);
  }
}

double Firmware::next() const {
  return motion_ && !is_stalled_ ? motion_->end : std::numeric_limits<double>::infinity();
}

std::string Firmware::take_output() {
  return std::exchange(output_, {});
}

double Firmware::table(double now) const {
  return static_cast<double>(table_ + made(now)) * degrees_per_step();
}

double Firmware::goal() const {
  const long left = motion_ && !is_stalled_ ? motion_->steps : 0;
  return static_cast<double>(table_ + left) * degrees_per_step();
}

void Firmware::move_by(long steps, double now) {
  const double speed = settings_.degrees_per_second;
  const double seconds =
      speed > 0 ? static_cast<double>(std::labs(steps)) * degrees_per_step() / speed : 0;
  motion_ = Motion{.steps = steps, .begin = now, .end = now + seconds};
}

long Firmware::made(double now) const {
  if (!motion_ || is_stalled_) return 0;
  const double whole = motion_->end - motion_->begin;
  const double part = whole > 0 ? std::clamp((now - motion_->begin) / whole, 0.0, 1.0) : 1;
  return std::lround(part * static_cast<double>(motion_->steps));
}

long Firmware::stop_moving(double now) {
  const long steps = made(now);
  table_ += steps;
  motion_.reset();
  return steps;
}

}  // namespace vitrine::acquisition::rig
