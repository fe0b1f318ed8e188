// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <utility>
#include <vector>

#include "acquisition/device/controller.h"
#include "acquisition/device/conversation.h"
#include "acquisition/device/horus.h"

namespace vitrine::acquisition {
namespace {

using horus::ReplyKind;
using std::chrono::milliseconds;

class HorusController final : public Controller {
 public:
  HorusController(SerialPort& port, milliseconds timeout)
      : talk_(port, '\n'), name_(port.name()), timeout_(timeout) {}

  Expected<std::string> greet() override;
  Expected<std::optional<double>> position() override;
  Expected<void> set_position(double degrees) override;
  Expected<void> turn_to(double degrees) override;
  Expected<void> laser(bool on) override { return command(horus::laser(1, on), timeout_); }
  Expected<void> switch_off() override;
  bool halt() noexcept override;

 private:
  // Waits for a reply of the given kind and skips all other replies before it. Returns nullopt
  // after `deadline`.
  Expected<std::optional<horus::Reply>> await(ReplyKind kind,
                                              SerialPort::Clock::time_point deadline);
  Expected<std::optional<horus::Reply>> ask_modes();
  Expected<std::string> ask_version();
  Expected<std::string> restart();
  Expected<void> command(const std::string& line, milliseconds timeout);
  Expected<double> counter();
  Expected<void> turn(double degrees, int speed);
  Unexpected no_answer(std::string_view line) const;
  Unexpected refused(std::string_view line, const horus::Reply& reply) const;

  Conversation talk_;
  std::string name_, heard_;  // heard_: the last line that is not a valid Horus reply
  milliseconds timeout_;
  bool is_counted_ = false;  // whether the board's counter is valid
  bool is_motor_on_ = false;
};

Unexpected HorusController::no_answer(std::string_view line) const {
  return fail(ErrorCode::kIo,
              fmt::format("{} does not answer '{}' in time; check the motor's power "
                          "and that the table turns freely",
                          name_, line));
}

Unexpected HorusController::refused(std::string_view line, const horus::Reply& reply) const {
  switch (reply.kind) {
    case ReplyKind::kBanner:
      return fail(ErrorCode::kIo, name_ + " has restarted; check its power supply and its cable");
    case ReplyKind::kAlarm:
      return fail(ErrorCode::kIo,
                  fmt::format("{} stopped with '{}'; check that the table turns freely", name_,
                              reply.text));
    case ReplyKind::kRefusal:
      return fail(ErrorCode::kIo,
                  fmt::format("{} refuses '{}' with '{}'; check its firmware's version", name_,
                              line, reply.text));
    default:
      return fail(ErrorCode::kIo,
                  fmt::format("{} gives an answer to '{}' that Horus firmware does not give; check "
                              "its cable and its firmware",
                              name_, line));
  }
}

Expected<void> HorusController::command(const std::string& line, milliseconds timeout) {
  const auto deadline = SerialPort::Clock::now() + timeout;
  if (auto said = talk_.say(line); !said) return said;
  while (true) {
    const auto heard = talk_.hear(deadline);
    if (!heard) return tl::unexpected(heard.error());
    if (!*heard) return no_answer(line);
    const horus::Reply reply = horus::parse(**heard);
    if (reply.kind == ReplyKind::kOk) return {};
    if (reply.kind != ReplyKind::kRemark && reply.kind != ReplyKind::kModes &&
        reply.kind != ReplyKind::kVersion)
      return refused(line, reply);
  }
}

Expected<std::optional<horus::Reply>> HorusController::await(
    ReplyKind kind, SerialPort::Clock::time_point deadline) {
  while (true) {
    const auto heard = talk_.hear(deadline);
    if (!heard) return tl::unexpected(heard.error());
    if (!*heard) return std::nullopt;
    horus::Reply reply = horus::parse(**heard);
    if (reply.kind == kind) return reply;
    if (reply.kind == ReplyKind::kUnknown) heard_ = **heard;
  }
}

// Repeats the query until the board answers. An Arduino that has just been plugged in is still
// starting up, and a motion that an earlier process started must end first.
Expected<std::optional<horus::Reply>> HorusController::ask_modes() {
  for (milliseconds asked{0}; asked < kBoot; asked += kAskAgain) {
    const auto deadline = SerialPort::Clock::now() + kAskAgain;
    if (auto said = talk_.say(std::string("\n") + horus::kAskModes); !said)
      return tl::unexpected(said.error());
    auto modes = await(ReplyKind::kModes, deadline);
    if (!modes || *modes) return modes;
  }
  return std::nullopt;
}

// Returns the text of the banner without restarting the board. The text has no version if the board
// does not answer the version query.
Expected<std::string> HorusController::ask_version() {
  const auto deadline = SerialPort::Clock::now() + kAskAgain;
  if (auto said = talk_.say(horus::kAskVersion); !said) return tl::unexpected(said.error());
  const auto version = await(ReplyKind::kVersion, deadline);
  if (!version) return tl::unexpected(version.error());
  return *version ? "Horus " + (*version)->text : "Horus";
}

Expected<std::string> HorusController::restart() {
  const auto deadline = SerialPort::Clock::now() + timeout_;
  if (auto sent = talk_.port().write({&horus::kReset, 1}); !sent)
    return tl::unexpected(sent.error());
  const auto banner = await(ReplyKind::kBanner, deadline);
  if (!banner) return tl::unexpected(banner.error());
  if (*banner && (*banner)->text.starts_with("Horus ")) return (*banner)->text;
  const std::string said = *banner ? (*banner)->text : heard_;
  if (said.empty())
    return fail(ErrorCode::kIo, name_ + " does not answer; check its power and its firmware");
  return fail(ErrorCode::kBadInput,
              fmt::format("{} is not a Horus board, it answers '{}'; check vendor, product and "
                          "dialect",
                          name_, said == LineReader::kGarbage ? "(unreadable)" : said));
}

// Does not restart a board that knows its position, because a restart would clear the position.
Expected<std::string> HorusController::greet() {
  const auto modes = ask_modes();
  if (!modes) return tl::unexpected(modes.error());
  is_counted_ = *modes && (*modes)->value == horus::kCountedSpeed * 60;
  const Expected<std::string> firmware = is_counted_ ? ask_version() : restart();
  if (!firmware) return firmware;
  if (auto ignored = talk_.ignore_all(kQuiet); !ignored) return tl::unexpected(ignored.error());
  if (auto unlocked = command(horus::kUnlock, timeout_); !unlocked)
    return tl::unexpected(unlocked.error());
  return firmware;
}

Expected<double> HorusController::counter() {
  const auto deadline = SerialPort::Clock::now() + timeout_;
  if (auto said = talk_.port().write({&horus::kAskStatus, 1}); !said)
    return tl::unexpected(said.error());
  while (true) {
    const auto heard = talk_.hear(deadline);
    if (!heard) return tl::unexpected(heard.error());
    if (!*heard) return no_answer("?");
    const horus::Reply reply = horus::parse(**heard);
    if (reply.kind == ReplyKind::kStatus) return reply.value;
    if (reply.kind != ReplyKind::kRemark) return refused("?", reply);
  }
}

Expected<std::optional<double>> HorusController::position() {
  const Expected<double> at = counter();
  if (!at) return tl::unexpected(at.error());
  return is_counted_ ? std::optional(*at) : std::nullopt;
}

Expected<void> HorusController::turn(double degrees, int speed) {
  const Expected<double> from = counter();
  if (!from) return tl::unexpected(from.error());
  if (!is_motor_on_) {
    if (auto on = command(horus::kMotorOn, timeout_); !on) return on;
    is_motor_on_ = true;
  }
  const double seconds = horus::longest(degrees - *from, speed);
  return command(horus::turn(degrees, speed),
                 timeout_ + milliseconds(static_cast<std::int64_t>(1000 * seconds)));
}

// Moves the table to 0 first, because the counter can be reset only there. The motion runs at the
// speed that marks the counter as invalid, so an interruption leaves it marked as invalid.
Expected<void> HorusController::set_position(double degrees) {
  if (degrees != 0) {
    const Expected<double> at = counter();
    if (!at) return tl::unexpected(at.error());
    is_counted_ = false;
    if (auto turned = turn(*at - degrees, horus::kUncountedSpeed); !turned) return turned;
  }
  if (auto zero = command(horus::kZeroHere, timeout_); !zero) return zero;
  const auto counted = degrees != 0 ? turn(degrees, horus::kCountedSpeed)
                                    : command(horus::speed(horus::kCountedSpeed), timeout_);
  is_counted_ = counted.has_value();
  return counted;
}

Expected<void> HorusController::turn_to(double degrees) {
  return turn(degrees, is_counted_ ? horus::kCountedSpeed : horus::kUncountedSpeed);
}

Expected<void> HorusController::switch_off() {
  is_motor_on_ = false;
  for (const std::string& line :
       {horus::laser(1, false), horus::laser(2, false), std::string(horus::kMotorOff)})
    if (auto done = command(line, timeout_); !done) return done;
  return {};
}

bool HorusController::halt() noexcept {
  return talk_.port().write({&horus::kReset, 1}).has_value();
}

}  // namespace

std::unique_ptr<Controller> make_horus(SerialPort& port, milliseconds timeout) {
  return std::make_unique<HorusController>(port, timeout);
}

}  // namespace vitrine::acquisition
