// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <utility>
#include <vector>

#include "acquisition/device/controller.h"
#include "acquisition/device/conversation.h"
#include "acquisition/device/horus.h"

namespace vitrine {
namespace {

using Kind = horus::Reply::Kind;
using std::chrono::milliseconds;

class HorusController final : public Controller {
 public:
  HorusController(SerialPort& port, milliseconds patience)
      : talk_(port, '\n'), name_(port.name()), patience_(patience) {}

  Expected<std::string> greet() override;
  Expected<std::optional<double>> position() override;
  Expected<void> set_position(double degrees) override;
  Expected<void> turn_to(double degrees) override;
  Expected<void> laser(bool on) override { return command(horus::laser(1, on), patience_); }
  Expected<void> switch_off() override;
  void halt() noexcept override;

 private:
  // Waits for a reply of that kind, past remarks and confirmations.
  Expected<std::optional<horus::Reply>> await(Kind kind, milliseconds patience);
  Expected<std::optional<horus::Reply>> ask_modes();
  Expected<std::string> ask_version();
  Expected<std::string> restart();
  Expected<void> command(const std::string& line, milliseconds patience);
  Expected<double> counter();
  Expected<void> turn(double degrees, int speed);
  Unexpected no_answer(std::string_view line) const;
  Unexpected refused(std::string_view line, const horus::Reply& reply) const;

  Conversation talk_;
  std::string name_, heard_;  // heard_: the last line that is no Horus board's
  milliseconds patience_;
  bool counted_ = false;  // whether the board's counter means something
  bool motor_ = false;
};

Unexpected HorusController::no_answer(std::string_view line) const {
  return fail(ErrorCode::kIo,
              fmt::format("{} does not answer '{}' in time; check the motor's power "
                          "and that the table turns freely",
                          name_, line));
}

Unexpected HorusController::refused(std::string_view line, const horus::Reply& reply) const {
  switch (reply.kind) {
    case Kind::kBanner:
      return fail(ErrorCode::kIo, name_ + " has restarted; check its power supply and its cable");
    case Kind::kAlarm:
      return fail(
          ErrorCode::kIo,
          fmt::format("{} stopped with '{}'; see that the table turns freely", name_, reply.text));
    case Kind::kRefusal:
      return fail(ErrorCode::kIo,
                  fmt::format("{} refuses '{}' with '{}'; check its firmware's version", name_,
                              line, reply.text));
    default:
      return fail(ErrorCode::kIo,
                  fmt::format("{} answers '{}' with what Horus firmware does not say; check its "
                              "cable and its firmware",
                              name_, line));
  }
}

Expected<void> HorusController::command(const std::string& line, milliseconds patience) {
  if (auto said = talk_.say(line); !said) return said;
  const auto deadline = SerialPort::Clock::now() + patience;
  while (true) {
    const auto heard = talk_.hear(deadline);
    if (!heard) return Unexpected(heard.error());
    if (!*heard) return no_answer(line);
    const horus::Reply reply = horus::parse(**heard);
    if (reply.kind == Kind::kOk) return {};
    if (reply.kind != Kind::kRemark && reply.kind != Kind::kModes && reply.kind != Kind::kVersion)
      return refused(line, reply);
  }
}

Expected<std::optional<horus::Reply>> HorusController::await(Kind kind, milliseconds patience) {
  const auto deadline = SerialPort::Clock::now() + patience;
  while (true) {
    const auto heard = talk_.hear(deadline);
    if (!heard) return Unexpected(heard.error());
    if (!*heard) return std::nullopt;
    horus::Reply reply = horus::parse(**heard);
    if (reply.kind == kind) return reply;
    if (reply.kind == Kind::kUnknown) heard_ = **heard;
  }
}

// Asked again and again, because an Arduino that has just been plugged in starts first, and a
// motion that an earlier process began is completed first.
Expected<std::optional<horus::Reply>> HorusController::ask_modes() {
  for (milliseconds asked{0}; asked < kBoot; asked += kAskAgain) {
    if (auto said = talk_.say(std::string("\n") + horus::kAskModes); !said)
      return Unexpected(said.error());
    auto modes = await(Kind::kModes, kAskAgain);
    if (!modes || *modes) return modes;
  }
  return std::nullopt;
}

// What the banner says, of a board that is not to say it; without the version where it does not
// know the question.
Expected<std::string> HorusController::ask_version() {
  if (auto said = talk_.say(horus::kAskVersion); !said) return Unexpected(said.error());
  const auto version = await(Kind::kVersion, kAskAgain);
  if (!version) return Unexpected(version.error());
  return *version ? "Horus " + (*version)->text : "Horus";
}

Expected<std::string> HorusController::restart() {
  if (auto sent = talk_.port().write({&horus::kReset, 1}); !sent) return Unexpected(sent.error());
  const auto banner = await(Kind::kBanner, patience_);
  if (!banner) return Unexpected(banner.error());
  if (*banner && (*banner)->text.starts_with("Horus ")) return (*banner)->text;
  const std::string said = *banner ? (*banner)->text : heard_;
  if (said.empty())
    return fail(ErrorCode::kIo, name_ + " does not answer; check its power and its firmware");
  return fail(ErrorCode::kBadInput,
              fmt::format("{} is no Horus board, it says '{}'; check vendor, product and dialect",
                          name_, said == LineReader::kGarbage ? "(unreadable)" : said));
}

// A board that holds a position is not restarted: that would forget it.
Expected<std::string> HorusController::greet() {
  const auto modes = ask_modes();
  if (!modes) return Unexpected(modes.error());
  counted_ = *modes && (*modes)->value == horus::kCountedSpeed * 60;
  const Expected<std::string> firmware = counted_ ? ask_version() : restart();
  if (!firmware) return firmware;
  if (auto ignored = talk_.ignore_all(kQuiet); !ignored) return Unexpected(ignored.error());
  if (auto unlocked = command(horus::kUnlock, patience_); !unlocked)
    return Unexpected(unlocked.error());
  return firmware;
}

Expected<double> HorusController::counter() {
  if (auto said = talk_.port().write({&horus::kAskStatus, 1}); !said)
    return Unexpected(said.error());
  const auto deadline = SerialPort::Clock::now() + patience_;
  while (true) {
    const auto heard = talk_.hear(deadline);
    if (!heard) return Unexpected(heard.error());
    if (!*heard) return no_answer("?");
    const horus::Reply reply = horus::parse(**heard);
    if (reply.kind == Kind::kStatus) return reply.value;
    if (reply.kind != Kind::kRemark) return refused("?", reply);
  }
}

Expected<std::optional<double>> HorusController::position() {
  const Expected<double> at = counter();
  if (!at) return Unexpected(at.error());
  return counted_ ? std::optional(*at) : std::nullopt;
}

Expected<void> HorusController::turn(double degrees, int speed) {
  const Expected<double> from = counter();
  if (!from) return Unexpected(from.error());
  if (!motor_) {
    if (auto on = command(horus::kMotorOn, patience_); !on) return on;
    motor_ = true;
  }
  const double seconds = horus::longest(degrees - *from, speed);
  return command(horus::turn(degrees, speed),
                 patience_ + milliseconds(static_cast<std::int64_t>(1000 * seconds)));
}

// The counter can be set at 0 alone, so the table goes there first. It moves at the uncounted speed
// until all is true.
Expected<void> HorusController::set_position(double degrees) {
  if (degrees != 0) {
    const Expected<double> at = counter();
    if (!at) return Unexpected(at.error());
    counted_ = false;
    if (auto turned = turn(*at - degrees, horus::kUncountedSpeed); !turned) return turned;
  }
  if (auto zero = command(horus::kZeroHere, patience_); !zero) return zero;
  const auto counted = degrees != 0 ? turn(degrees, horus::kCountedSpeed)
                                    : command(horus::speed(horus::kCountedSpeed), patience_);
  counted_ = counted.has_value();
  return counted;
}

Expected<void> HorusController::turn_to(double degrees) {
  return turn(degrees, counted_ ? horus::kCountedSpeed : horus::kUncountedSpeed);
}

Expected<void> HorusController::switch_off() {
  motor_ = false;
  for (const std::string& line :
       {horus::laser(1, false), horus::laser(2, false), std::string(horus::kMotorOff)})
    if (auto done = command(line, patience_); !done) return done;
  return {};
}

void HorusController::halt() noexcept {
  (void)talk_.port().write({&horus::kReset, 1});
}

}  // namespace

std::unique_ptr<Controller> make_horus(SerialPort& port, milliseconds patience) {
  return std::make_unique<HorusController>(port, patience);
}

}  // namespace vitrine
