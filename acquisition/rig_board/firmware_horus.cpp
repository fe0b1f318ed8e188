// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>

#include "acquisition/rig_board/firmware.h"

namespace vitrine::acquisition::rig {
namespace {

constexpr std::size_t kLongestLine = 70;  // length of a line in bytes, as in Grbl

using Words = std::map<char, double>;

// Splits G-code such as "G1X10F200" by letter. Returns nullopt if the line is not G-code.
std::optional<Words> words_of(std::string_view line) {
  Words words;
  while (!line.empty()) {
    const char letter = line.front();
    double value = 0;
    const auto [end, error] = std::from_chars(line.data() + 1, line.data() + line.size(), value);
    if (letter < 'A' || letter > 'Z' || error != std::errc{} ||
        !words.emplace(letter, value).second)
      return std::nullopt;
    line.remove_prefix(static_cast<std::size_t>(end - line.data()));
  }
  return words;
}

class Horus final : public Firmware {
 public:
  explicit Horus(const FirmwareSettings& settings) : Firmware(settings) {}

 private:
  void take(char byte, double now) override;
  void forget() override;
  void completed(double now) override;
  void reset(double now);
  void say_status();
  void obey_waiting(double now);
  void obey(const std::string& line, double now);
  void obey_system(const std::string& line);
  void obey_words(const Words& words, double now);
  const char* fault_of(const Words& words) const;
  void turn(double degrees, double now);

  std::string waiting_;   // bytes received while the table turns
  long counter_ = 0;      // steps that the board has counted
  long heading_for_ = 0;  // counter at the end of the current motion, in steps
  double feed_ = 0;       // degrees per second; 0: not set yet
  bool is_locked_ = false;
};

void Horus::take(char byte, double now) {
  if (byte == 0x18) return reset(now);
  if (byte == '?') return say_status();
  if (byte != '\r' && byte != ' ') waiting_ += byte;
  obey_waiting(now);
}

void Horus::forget() {
  waiting_.clear();
  counter_ = 0;
  feed_ = 0;
  is_locked_ = false;
  say("\r\nHorus 0.2 ['$' for help]\r\n");
}

// Simulates a soft reset, which keeps the counter. A reset during a motion raises an alarm.
void Horus::reset(double now) {
  const bool amid = moving();
  counter_ += stop_moving(now);
  const long counter = counter_;
  is_laser_on_ = is_motor_on_ = false;
  if (amid) say("ALARM: Abort during cycle\r\n");
  forget();
  counter_ = counter;
  is_locked_ = amid;
  if (is_locked_) say("['$H'|'$X' to unlock]\r\n");
}

void Horus::say_status() {
  const double at = static_cast<double>(counter_) * degrees_per_step();
  say(fmt::format("<{},MPos:{:.3f}>\r\n", moving() ? "Run" : is_locked_ ? "Alarm" : "Idle", at));
}

void Horus::completed(double now) {
  counter_ = heading_for_;
  say("ok\r\n");
  obey_waiting(now);
}

void Horus::obey_waiting(double now) {
  for (std::size_t end = 0; !moving() && (end = waiting_.find('\n')) != std::string::npos;) {
    const std::string line = waiting_.substr(0, end);
    waiting_.erase(0, end + 1);
    obey(line, now);
  }
}

void Horus::obey(const std::string& line, double now) {
  if (line.size() > kLongestLine) return say("error: Line overflow\r\n");
  if (line.starts_with('$')) return obey_system(line);
  if (is_locked_) return say("error: Alarm lock\r\n");
  const auto words = words_of(line);
  if (!words) return say("error: Bad number format\r\n");
  if (const char* fault = fault_of(*words)) return say(fmt::format("error: {}\r\n", fault));
  obey_words(*words, now);
  if (!moving()) say("ok\r\n");
}

void Horus::obey_system(const std::string& line) {
  if (line == "$G") {
    say(fmt::format("[G1 G54 T0 F{:.0f}.]\r\n", feed_ * 60));
  } else if (line == "$I") {
    say("[0.2:]\r\n");
  } else if (line == "$X") {
    if (is_locked_) say("[Caution: Unlocked]\r\n");
    is_locked_ = false;
  } else {
    return say("error: Invalid statement\r\n");
  }
  say("ok\r\n");
}

const char* Horus::fault_of(const Words& words) const {
  for (const auto& [letter, value] : words) {
    const bool known =
        letter == 'F' || letter == 'T' || letter == 'X' ||
        (letter == 'G' && (value == 1 || value == 50)) ||
        (letter == 'M' && (value == 17 || value == 18 || value == 70 || value == 71));
    if (!known) return "Unsupported command";
    if ((letter == 'F' || letter == 'T') && value < 0) return "Value < 0";
  }
  const bool turns = words.contains('X') || (words.contains('G') && words.at('G') == 1);
  return turns && feed_ == 0 && !words.contains('F') ? "Undefined feed rate" : nullptr;
}

void Horus::obey_words(const Words& words, double now) {
  if (words.contains('F')) feed_ = words.at('F');
  if (words.contains('M')) {
    const double code = words.at('M');
    if (code == 17 || code == 18) is_motor_on_ = code == 17;
    if (code >= 70 && words.contains('T') && words.at('T') == 1) is_laser_on_ = code == 71;
  }
  if (words.contains('G') && words.at('G') == 50) counter_ = 0;
  if (words.contains('X')) turn(words.at('X'), now);
}

// Counts steps even if the motor is off and the table stands still. Like a real board, the
// simulated board cannot detect this.
void Horus::turn(double degrees, double now) {
  heading_for_ = std::lround(std::clamp(degrees, -1e6, 1e6) / degrees_per_step());
  if (is_motor_on_)
    move_by(heading_for_ - counter_, now);
  else
    counter_ = heading_for_;
}

}  // namespace

std::unique_ptr<Firmware> horus_firmware(const FirmwareSettings& settings) {
  return std::make_unique<Horus>(settings);
}

}  // namespace vitrine::acquisition::rig
