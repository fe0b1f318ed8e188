// SPDX-License-Identifier: Apache-2.0
#include "fake_scanner.h"
#include "support/product_names.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vitrine::test {
namespace {

// Counts a call of the device function `name`. Returns an error if FakeWorld::fault returns true
// for this call.
Expected<void> call(FakeWorld& world, const std::string& name) {
  int count = 0;
  {
    const std::lock_guard lock(world.mutex);
    count = ++world.calls[name];
  }
  if (world.meanwhile) world.meanwhile(name, count);
  const std::lock_guard lock(world.mutex);
  if (world.fault && world.fault(name, count))
    return fail(ErrorCode::kIo, "the device is gone at \"" + name + "\"; plug it in");
  return {};
}

// Returns noise that depends only on the angle, the laser and the pixel. A repeated capture
// therefore gives the same picture.
int noise(double degrees, bool laser, int pixel) {
  std::uint64_t x = static_cast<std::uint64_t>(std::lround(degrees * 1'000)) * 2 + laser;
  x = (x << 24) + static_cast<std::uint64_t>(pixel);
  x ^= x >> 31, x *= 0x9E3779B97F4A7C15, x ^= x >> 29, x *= 0xBF58476D1CE4E5B9, x ^= x >> 32;
  return static_cast<int>(x % 7);
}

double stripe(double u, double centre) {
  return 180 * std::exp(-(u - centre) * (u - centre) / (2 * 2.5 * 2.5));
}

class FakeCamera : public Camera {
 public:
  explicit FakeCamera(FakeWorld& world) : world_(world), identity_{"fake", "fake", world.serial} {
    const std::lock_guard lock(world_.mutex);
    ++world_.open_cameras;
  }
  ~FakeCamera() override {
    const std::lock_guard lock(world_.mutex);
    --world_.open_cameras;
  }

  const CameraIdentity& identity() const override { return identity_; }
  SensorRegion region() const override { return {0, 0, kFakeWidth, kFakeHeight}; }
  Expected<void> configure(const CameraSettings&) override { return call(world_, "configure"); }

  Expected<Frame> capture() override {
    if (auto there = call(world_, "capture"); !there) return tl::unexpected(there.error());
    const std::lock_guard lock(world_.mutex);
    if (world_.repeats && world_.repeats(world_.calls["capture"])) return last_;
    Frame frame{kFakeWidth, kFakeHeight, std::vector<std::uint8_t>(kFakeWidth * kFakeHeight)};
    for (int i = 0; i < kFakeWidth * kFakeHeight; ++i) {
      const int u = i % kFakeWidth, v = i / kFakeWidth;
      const double grey = ambient(i) + light(u, v);
      frame.pixels[i] = static_cast<std::uint8_t>(std::clamp(grey, 0.0, 255.0));
    }
    return last_ = frame;
  }

 private:
  double ambient(int pixel) const {
    if (world_.is_ideal) return pixel % kFakeWidth < kFakeWidth / 2 ? 10 : 20;
    return 10 + noise(world_.degrees, world_.laser, pixel);
  }
  double light(int u, int v) const {
    if (world_.object == FakeObject::kOverExposed) return 255;
    if (!world_.laser || world_.object == FakeObject::kNothing) return 0;
    if (world_.object == FakeObject::kEmptyTable && v < kFakeHeight - 3) return 0;
    const double centre = kFakeWidth / 2.0 + fake_radius(world_.degrees) / kFakePixel;
    if (world_.object == FakeObject::kSaturated) return 10 * stripe(u, centre);
    if (world_.object == FakeObject::kTwoStripes) return stripe(u, centre) + stripe(u, 16);
    if (world_.object == FakeObject::kTwoSurfaces && v >= kFakeOtherRow)
      return stripe(u, centre) + .4 * stripe(u, centre - 40);
    return stripe(u, centre);
  }

  FakeWorld& world_;
  const CameraIdentity identity_;
  Frame last_;
};

class FakeBoard : public Board {
 public:
  explicit FakeBoard(FakeWorld& world) : world_(world) {
    const std::lock_guard lock(world_.mutex);
    ++world_.open_boards;
    world_.stopped = world_.laser = world_.motor = false;
    if (world_.forgets_position) world_.position_known = false;
  }
  ~FakeBoard() override {
    const std::lock_guard lock(world_.mutex);
    --world_.open_boards;
  }

  const BoardIdentity& identity() const override { return identity_; }

  Expected<std::optional<double>> position() override {
    if (auto there = use("position"); !there) return tl::unexpected(there.error());
    const std::lock_guard lock(world_.mutex);
    return world_.position_known ? std::optional(world_.degrees) : std::nullopt;
  }
  // position() still returns the true angle afterwards. If a caller declares a wrong angle, later
  // calls of turn_to() turn the table to wrong angles.
  Expected<void> set_position(double degrees) override {
    if (auto there = use("set position"); !there) return there;
    const std::lock_guard lock(world_.mutex);
    shift_ = world_.degrees - degrees;
    world_.position_known = true;
    return {};
  }
  Expected<void> turn_to(double degrees) override {
    if (auto there = use("turn"); !there) return there;
    const std::lock_guard lock(world_.mutex);
    world_.degrees = degrees + shift_;
    world_.motor = true;
    return {};
  }
  Expected<void> laser(bool on) override {
    if (auto there = use(on ? "laser on" : "laser off"); !there) return there;
    const std::lock_guard lock(world_.mutex);
    world_.laser = on;
    return {};
  }
  Expected<void> rest() override {
    if (auto there = use("rest"); !there) return there;
    const std::lock_guard lock(world_.mutex);
    world_.laser = world_.motor = false;
    return {};
  }
  void emergency_stop() noexcept override {
    const std::lock_guard lock(world_.mutex);
    world_.stopped = true;
    world_.laser = world_.motor = false;
  }

 private:
  // Counts a call of the board. If the board is lost, switches laser and motor off, because an
  // unplugged board has no power.
  Expected<void> use(const std::string& name) {
    auto there = call(world_, name);
    const std::lock_guard lock(world_.mutex);
    if (!there) lost_ = true;
    if (lost_) {
      world_.laser = world_.motor = false;
      return fail(ErrorCode::kIo, "the board is gone; plug it in");
    }
    if (world_.stopped) return fail(ErrorCode::kState, "emergency stop; make sure it is safe");
    return {};
  }

  FakeWorld& world_;
  const BoardIdentity identity_{"horus", "fake", "board-1"};
  double shift_ = 0;
  bool lost_ = false;
};

}  // namespace

double fake_radius(double degrees) {
  return 8 + 2 * std::cos(3 * degrees * std::numbers::pi / 180);
}

Calibration fake_calibration() {
  std::vector<Correspondence> points;
  for (int v = 0; v <= kFakeHeight; ++v) {
    for (int u = 0; u <= kFakeWidth; ++u) {
      const PlanePoint at{(u - kFakeWidth / 2) * kFakePixel, (kFakeHeight - v) * kFakePixel};
      points.push_back({static_cast<double>(u), static_cast<double>(v), at, v});
    }
  }
  Calibration calibration;
  calibration.created = "2026-01-01T00:00:00Z";
  calibration.camera = kFakeSerial;
  calibration.region = {0, 0, kFakeWidth, kFakeHeight};
  calibration.map = *PlaneMap::fit(points, 2, kFakeWidth + 1, kFakeHeight + 1);
  calibration.noise = 0.02;
  return calibration;
}

Scanner fake_scanner(FakeWorld& world, const std::filesystem::path& calibrations) {
  Scanner scanner;
  scanner.name = "fake";
  scanner.calibrations = calibrations;
  scanner.devices.open_camera = [&world]() -> Expected<std::unique_ptr<Camera>> {
    if (auto there = call(world, "open camera"); !there) return tl::unexpected(there.error());
    return std::make_unique<FakeCamera>(world);
  };
  scanner.devices.open_board = [&world]() -> Expected<std::unique_ptr<Board>> {
    if (auto there = call(world, "open board"); !there) return tl::unexpected(there.error());
    return std::make_unique<FakeBoard>(world);
  };
  return scanner;
}

}  // namespace vitrine::test
