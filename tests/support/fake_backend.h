// SPDX-License-Identifier: Apache-2.0
// A scanner without devices. Its scans are profiles of a tube. A scan's folder has one line per
// step, so that a scan survives a restart. A test can hold a scan at a step, or let the step fail.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "server/jobs/scanner_backend.h"
#include "support/meshes.h"
#include "support/product_names.h"

namespace vitrine::test {

// State that the test reads and changes. It must outlive the backend.
struct FakeScanner {
  std::string name = "rig";
  std::function<std::optional<Error>(int step)> before_step;  // called before each step; may block
  std::function<void()> while_opening;  // called at the start of identify(); may block
  std::function<void()> while_turning;  // called by jog() while the table turns; may block
  std::function<void(const ScanOrder&)> while_rebuilding;  // called by rebuild_mesh(); may block

  bool stopped() const { return stops > allowed; }

  bool is_placed_by_hand = false;  // whether the operator places the target
  std::string note;                // the note that a scan reports at each step
  ScanOrder rebuilt;               // the newest order given to rebuild_mesh()

  std::atomic<bool> reachable{true}, jams{false}, laser{false}, open{false};
  std::atomic<std::uint64_t> stops{0}, allowed{0};
  std::atomic<int> calls{0}, steps{0}, calibrations{1}, damaged{0};
  std::atomic<double> degrees{0};
  PowerRecord power;         // state of laser and motor; both are off at first
  std::atomic<int> kept{0};  // number of calls of keep_laser()

  FakeScanner() { power.both_off(); }
  void light(bool on) {
    laser = on;
    power.laser(on ? LaserState::kOn : LaserState::kOff);
  }
};

inline constexpr std::size_t kFakePoints = 10;  // number of points that each step of a scan adds

class FakeView final : public ScanView {
 public:
  explicit FakeView(int steps) : steps_(steps) {}

  ScanProgress progress() const override {
    const int step = static_cast<int>(points() / kFakePoints);
    return {.step = step, .progress = 0.9 * step / steps_, .calibration = 1};
  }
  void add_step(int step) {
    const std::scoped_lock lock(mutex_);
    for (std::size_t i = 0; i < kFakePoints; ++i) {
      points_.push_back({static_cast<float>(step), static_cast<float>(i), 1});
    }
  }
  std::shared_ptr<const Frame> frame() const override {
    return std::make_shared<Frame>(Frame{2, 1, {7, 9}});
  }
  std::vector<std::array<double, 2>> profile() const override { return {{12.5, 3}, {12.25, 4}}; }
  std::size_t points() const override {
    const std::scoped_lock lock(mutex_);
    return points_.size();
  }
  std::vector<std::array<float, 3>> points_from(std::size_t first) const override {
    const std::scoped_lock lock(mutex_);
    const auto begin = static_cast<std::ptrdiff_t>(std::min(first, points_.size()));
    return {points_.begin() + begin, points_.end()};
  }

 private:
  const int steps_;
  mutable std::mutex mutex_;
  std::vector<std::array<float, 3>> points_;
};

class FakeBackend final : public ScannerBackend {
 public:
  explicit FakeBackend(FakeScanner& world) : world_(world) {}

  Expected<ScannerIdentity> identify() override {
    if (world_.while_opening) world_.while_opening();
    if (auto ready = use(); !ready) return tl::unexpected(ready.error());
    ScannerIdentity identity{{"Acme", "C1", "42"}, {"horus", "fake 1.0", "7"}, std::nullopt};
    if (world_.calibrations > 0) identity.calibration = world_.calibrations;
    return identity;
  }
  Expected<void> jog(double degrees) override {
    if (auto ready = use(); !ready) return ready;
    if (world_.jams) return fail(ErrorCode::kIo, "the motor is stuck; free the table");
    world_.power.motor(MotorState::kTurning);
    if (world_.while_turning) world_.while_turning();
    world_.power.motor(MotorState::kOff);
    world_.light(false);
    if (auto ready = use(); !ready) return ready;
    world_.degrees = world_.degrees + degrees;
    return {};
  }
  Expected<void> laser(bool on) override {
    if (auto ready = use(); !ready) return ready;
    world_.light(on);
    return {};
  }
  Expected<void> keep_laser() override {
    ++world_.kept;
    return use();
  }
  Expected<Frame> picture() override {
    if (auto ready = reach(); !ready) return tl::unexpected(ready.error());
    return Frame{1, 2, {3, 4}};
  }

  Expected<std::optional<TriangleMesh>> scan(const ScanOrder& order,
                                             const std::filesystem::path& folder,
                                             ScanListener& listener) override {
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "of") << order.request.steps;
    const auto view = std::make_shared<FakeView>(order.request.steps);
    int step = 0;
    for (const int stored = steps_in(folder); step < stored; ++step)
      view->add_step(step);
    listener.begins(view);
    world_.light(true);
    const LightsOff off{world_};
    for (; step < order.request.steps; ++step) {
      listener.report({.step = step,
                       .progress = 0.9 * step / order.request.steps,
                       .calibration = 1,
                       .note = world_.note});
      if (world_.before_step) {
        if (const auto error = world_.before_step(step)) return tl::unexpected(*error);
      }
      if (listener.is_interrupted()) return std::nullopt;
      if (auto ready = use(); !ready) return tl::unexpected(ready.error());
      std::ofstream(folder / "steps", std::ios::app) << step << std::endl;
      view->add_step(step);
      ++world_.steps;
    }
    listener.report({.stage = "meshing",
                     .step = step,
                     .progress = 0.9,
                     .calibration = 1,
                     .rows = ScannedRows{.empty = .5, .saturated = .25, .doubled = .125}});
    return torus(40, 20);
  }

  Expected<int> calibrate(const CalibrationOrder& order, CalibrationListener& listener) override {
    if (world_.before_step) {
      if (const auto error = world_.before_step(0)) return tl::unexpected(*error);
    }
    for (int pose = 0; world_.is_placed_by_hand && pose < order.poses; ++pose) {
      const auto asked = "place the target, pose " + std::to_string(pose + 1);
      if (!listener.await_operator({.stage = asked, .note = "so far it is seen"})) break;
    }
    if (listener.is_interrupted()) return fail(ErrorCode::kState, "interrupted; start it again");
    return ++world_.calibrations;
  }

  void close() override {
    world_.open = false;
    world_.light(false);
  }
  const std::string& name() const override { return world_.name; }
  BoardPower power() const override { return world_.power.read(); }
  void emergency_stop() noexcept override {
    ++world_.stops;
    world_.light(false);
    world_.power.motor(MotorState::kOff);
  }
  std::uint64_t stops() const noexcept override { return world_.stops; }
  void allow(std::uint64_t stops) noexcept override {
    world_.allowed = std::max(world_.allowed.load(), stops);
  }

  Expected<TriangleMesh> rebuild_mesh(const ScanOrder& order,
                                      const std::filesystem::path&) override {
    if (world_.while_rebuilding) world_.while_rebuilding(order);
    world_.rebuilt = order;
    return torus(40, 20);
  }
  Expected<std::shared_ptr<const ScanView>> view(const std::filesystem::path& folder) override {
    int steps = 1;
    std::ifstream(folder / "of") >> steps;
    auto view = std::make_shared<FakeView>(steps);
    for (int step = 0; step < steps_in(folder); ++step)
      view->add_step(step);
    return view;
  }
  Expected<std::vector<server::CalibrationSummary>> calibrations() override {
    std::vector<CalibrationSummary> all;
    if (world_.damaged > 0) all.push_back({world_.damaged, "0009.json is cut short; remove it"});
    for (int i = world_.calibrations; i > 0; --i)
      all.push_back({i, "", "2026-11-23T08:00:00Z", "42", {0, 0, 64, 48}, 0.02, 0.04, 0.06, 0.8});
    return all;
  }
  Expected<std::optional<std::string>> calibration_report(int number) override {
    if (number > world_.calibrations) return std::nullopt;
    return R"({"number":)" + std::to_string(number) + "}";
  }
  Expected<std::optional<std::string>> residual_plot(int number) override {
    if (number > world_.calibrations) return std::nullopt;
    return "<svg/>";
  }

 private:
  struct LightsOff {
    FakeScanner& world;
    ~LightsOff() { world.light(false); }
  };

  Expected<void> use() {
    if (world_.stopped()) return fail(ErrorCode::kState, "stopped; release it");
    return reach();
  }
  Expected<void> reach() {
    ++world_.calls;
    world_.open = world_.reachable.load();
    if (world_.reachable) return {};
    return fail(ErrorCode::kIo, "camera 42 is gone; check its cable");
  }
  static int steps_in(const std::filesystem::path& folder) {
    std::ifstream in(folder / "steps");
    int count = 0;
    for (std::string line; std::getline(in, line);)
      ++count;
    return count;
  }

  FakeScanner& world_;
};

// Holds a scan before step `at` until open() is called.
class HeldAtStep {
 public:
  explicit HeldAtStep(FakeScanner& world, int at) {
    // The function shares `door_`, because it may run after this object is destroyed.
    world.before_step = [door = door_, at](int step) -> std::optional<Error> {
      std::unique_lock lock(door->mutex);
      if (step != at || door->open) return std::nullopt;
      door->arrived = true;
      door->changed.notify_all();
      door->changed.wait(lock, [&] { return door->open; });
      return std::nullopt;
    };
  }
  void await() {
    std::unique_lock lock(door_->mutex);
    door_->changed.wait(lock, [this] { return door_->arrived; });
  }
  void open() {
    const std::scoped_lock lock(door_->mutex);
    door_->open = true;
    door_->changed.notify_all();
  }

 private:
  struct Door {
    std::mutex mutex;
    std::condition_variable changed;
    bool arrived = false, open = false;
  };
  std::shared_ptr<Door> door_ = std::make_shared<Door>();
};

}  // namespace vitrine::test
