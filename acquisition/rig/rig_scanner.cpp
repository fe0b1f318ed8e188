// SPDX-License-Identifier: Apache-2.0
#include "acquisition/rig/rig_scanner.h"

#include <fmt/format.h>

#include <cerrno>
#include <chrono>
#include <cstring>

#include "acquisition/rig/table_file.h"
#include "acquisition/rig_optics/noise.h"

namespace vitrine::acquisition::rig {

std::string camera_serial(std::uint64_t seed) {
  return fmt::format("RIG{:06X}", scramble(seed) & 0xffffff);
}

UsbBoardSettings board_settings(std::uint64_t seed, bool fabscan) {
  UsbBoardSettings settings{.is_fabscan = fabscan, .serial = camera_serial(seed)};
  // A FabScan's stepper motor makes 3200 steps per revolution, at 16 microsteps.
  if (fabscan) settings.firmware.steps_per_turn = 3200;
  return settings;
}

namespace {

// Prints an error of a reconnection. The cable's own thread reconnects, so no caller can receive
// the error.
void report(const Expected<void>& outcome) {
  if (!outcome) fmt::print(stderr, "vitrine-rig: {}\n", outcome.error().message);
}

}  // namespace

RigScanner::RigScanner(const RigScannerOptions& options, double degrees)
    : options_(options),
      degrees_(degrees),
      renderer_(optics_of(options.realism.seed), options.object, options.realism),
      stage_([this](int turns) { turned(turns); }),
      board_({.on_goal = [this](double moved) { keep(degrees_ + moved); },
              .on_move = [this](double moved) { stage_.passes(degrees_ + moved); },
              .on_turn = [this](double moved) { stage_.turned_to(degrees_ + moved); },
              .on_laser = [this](bool on) { stage_.laser(on); },
              .on_motor = [this](bool on) { stage_.motor(on); },
              .on_command = [this](std::string_view text,
                                   auto submitted) { write_down(text, submitted); }}),
      camera_cable_([this] { camera_->unplug(); }, [this] { report(camera_->plug_in()); }),
      board_cable_([this] { board_.unplug(); }, [this] { report(plug_board()); }) {
  stage_.passes(degrees);
  if (!options.commands.empty()) commands_.open(options.commands);
}

Expected<std::unique_ptr<RigScanner>> RigScanner::start(const RigScannerOptions& options) {
  const auto degrees = options.table.empty() ? 0 : read_table(options.table);
  if (!degrees) return tl::unexpected(degrees.error());
  std::unique_ptr<RigScanner> scanner(new RigScanner(options, *degrees));
  if (!scanner->commands_) {
    return fail(ErrorCode::kIo, fmt::format("cannot write {}: {}; choose another file",
                                            options.commands.string(), std::strerror(errno)));
  }
  auto camera = GigeCamera::plug_in(
      {options.camera_address, camera_serial(options.realism.seed)},
      [self = scanner.get()](const Exposure& exposure, const SensorRegion& region) {
        return self->expose(exposure, region);
      });
  if (!camera) return tl::unexpected(camera.error());
  scanner->camera_ = std::move(*camera);
  if (const auto plugged = scanner->plug_board(); !plugged) return tl::unexpected(plugged.error());
  return scanner;
}

Expected<void> RigScanner::plug_board() {
  UsbBoardSettings settings = board_settings(options_.realism.seed, options_.is_fabscan);
  settings.firmware.degrees_per_second = options_.degrees_per_second;
  return board_.plug(settings);
}

// Saves the motion's goal when the motion begins, because a real table completes a motion even if
// this process is killed.
void RigScanner::keep(double goal) {
  if (!options_.table.empty()) report(write_table(options_.table, goal));
}

void RigScanner::write_down(std::string_view text,
                            std::chrono::system_clock::time_point submitted) {
  const auto since_1970 = submitted.time_since_epoch();
  const auto at = std::chrono::duration_cast<std::chrono::milliseconds>(since_1970).count();
  std::string shown;
  for (const char c : text)
    shown += c >= ' ' && c < '\x7f' ? std::string(1, c)
             : c == '\n'            ? ""
                                    : fmt::format("<{:02x}>", c);
  commands_ << at << ' ' << shown << std::endl;
}

void RigScanner::turned(int turns) {
  if (due(options_.faults, FaultKind::kCameraUnplug, turns)) camera_cable_.pull();
  if (due(options_.faults, FaultKind::kUsbUnplug, turns)) board_cable_.pull();
  if (due(options_.faults, FaultKind::kMotorStall, turns))
    brake_ = std::jthread([this] { board_.stall(); });
}

Delivery RigScanner::delivery(int turns) {
  ++frames_;
  if (due(options_.faults, FaultKind::kMissedTrigger, turns) && missed_at_ != turns) {
    missed_at_ = turns;
    return Delivery::kLost;
  }
  const bool lossy = lasting(options_.faults, FaultKind::kLostPackets, turns);
  const bool lacking = lossy && key_of(options_.realism.seed, 0x105, frames_) % 20 == 0;
  return lacking ? Delivery::kLacksPackets : Delivery::kWhole;
}

Exposed RigScanner::expose(const Exposure& exposure, const SensorRegion& region) {
  const Setting setting = stage_.now();
  const auto since = [&](FaultKind kind) { return lasting(options_.faults, kind, setting.turns); };
  const Shot shot{.setting = setting,
                  .exposure = exposure,
                  .region = region,
                  .laser_shift = crept(options_.faults, setting.turns),
                  .has_second_stripe = since(FaultKind::kSecondStripe),
                  .is_laser_out = since(FaultKind::kLaserOut)};
  return {renderer_.take(shot), delivery(setting.turns)};
}

}  // namespace vitrine::acquisition::rig
