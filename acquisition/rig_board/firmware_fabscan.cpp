// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdlib>
#include <string>
#include <utility>

#include "acquisition/rig_board/firmware.h"

namespace vitrine::acquisition::rig {
namespace {

constexpr std::size_t kBuffer = 64;

// Returns the integer after `letter` in the word that starts with `letter`, or `otherwise` if there
// is no such word.
long number_of(const std::string& line, char letter, long otherwise) {
  for (std::size_t at = 0; at < line.size(); at = line.find(' ', at)) {
    at += line[at] == ' ' ? 1 : 0;
    if (at < line.size() && line[at] == letter) return std::strtol(&line[at + 1], nullptr, 10);
    if (line.find(' ', at) == std::string::npos) break;
  }
  return otherwise;
}

class FabScan final : public Firmware {
 public:
  explicit FabScan(const FirmwareSettings& settings) : Firmware(settings) {}

 private:
  void take(char byte, double now) override;
  void forget() override;
  void completed(double now) override;
  void read_waiting(double now);
  void obey(double now);

  std::string waiting_, line_;
};

void FabScan::take(char byte, double now) {
  waiting_ += byte;
  read_waiting(now);
}

void FabScan::forget() {
  waiting_.clear();
  line_.clear();
}

void FabScan::completed(double now) {
  say(">");
  read_waiting(now);
}

// Reads, echoes and executes buffered input until a motion starts.
void FabScan::read_waiting(double now) {
  while (!moving() && !waiting_.empty()) {
    const char byte = waiting_.front();
    waiting_.erase(0, 1);
    if (byte == '\r') continue;
    say({&byte, 1});
    if (byte != '\n' && line_.size() < kBuffer) line_ += byte;
    if (byte == '\n') obey(now);
  }
}

void FabScan::obey(double now) {
  const std::string line = std::exchange(line_, {});
  const long g = number_of(line, 'G', -1);
  if (g >= 0 && g <= 2 && is_motor_on_) {
    constexpr long kWord = 1 << 15;  // the controller's int has 16 bits
    move_by(std::clamp(number_of(line, 'T', 0), -kWord, kWord - 1), now);
  }
  switch (number_of(line, 'M', -1)) {
    case 17:
      is_motor_on_ = true;
      break;
    case 18:
      is_motor_on_ = false;
      break;
    case 21:
      is_laser_on_ = true;
      break;
    case 22:
      is_laser_on_ = false;
      break;
    case 200:
      say("v.20160506\r\n");
      break;
    default:
      break;
  }
  if (!moving()) say(">");
}

}  // namespace

std::unique_ptr<Firmware> fabscan_firmware(const FirmwareSettings& settings) {
  return std::make_unique<FabScan>(settings);
}

}  // namespace vitrine::acquisition::rig
