// SPDX-License-Identifier: Apache-2.0
// Tests the simulated camera with an independent GigE Vision client, the library Aravis.
#include "acquisition/rig/rig_scanner.h"

#include <arv.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "acquisition/rig/private_network.h"
#include "support/rig_scenes.h"

namespace vitrine::acquisition::rig::test {
namespace {

struct Unref {
  void operator()(void* object) const { g_object_unref(object); }
};
using CameraPtr = std::unique_ptr<ArvCamera, Unref>;
using StreamPtr = std::unique_ptr<ArvStream, Unref>;
using BufferPtr = std::unique_ptr<ArvBuffer, Unref>;

const std::string kAddress = "127.0.0.1";

// Gives this process a private network, because tests run side by side and the port of GigE Vision
// is fixed. enter_private_network() must be called before a second thread exists.
class PrivateNetwork final : public ::testing::Environment {
 public:
  void SetUp() override {
    const auto entered = enter_private_network();
    ASSERT_TRUE(entered) << entered.error().message;
  }
};
const auto* const kNetwork = ::testing::AddGlobalTestEnvironment(new PrivateNetwork);

class Client {
 public:
  explicit Client(const std::string& address) : camera_(arv_camera_new(address.c_str(), nullptr)) {
    if (!camera_) return;
    arv_camera_set_exposure_time(camera_.get(), 5000, nullptr);
    arv_camera_set_trigger(camera_.get(), "Software", nullptr);
  }

  bool found() const { return camera_ != nullptr; }
  std::string serial() const { return arv_camera_get_device_serial_number(camera_.get(), nullptr); }
  void set_exposure(double us) { arv_camera_set_exposure_time(camera_.get(), us, nullptr); }
  void set_region(const SensorRegion& region) {
    arv_camera_set_region(camera_.get(), region.x, region.y, region.width, region.height, nullptr);
  }

  // Captures a frame. Returns nullopt if no frame arrives or the frame is incomplete.
  std::optional<Frame> capture() {
    if (!stream_) start();
    if (!stream_) return std::nullopt;
    arv_camera_software_trigger(camera_.get(), nullptr);
    const BufferPtr buffer(arv_stream_timeout_pop_buffer(stream_.get(), 1'500'000));
    if (!buffer) return std::nullopt;
    arv_stream_push_buffer(stream_.get(), arv_buffer_new(size_, nullptr));
    if (arv_buffer_get_status(buffer.get()) != ARV_BUFFER_STATUS_SUCCESS) return std::nullopt;
    std::size_t size = 0;
    const auto* bytes = static_cast<const std::uint8_t*>(arv_buffer_get_data(buffer.get(), &size));
    return Frame{arv_buffer_get_image_width(buffer.get()),
                 arv_buffer_get_image_height(buffer.get()),
                 {bytes, bytes + size}};
  }

 private:
  void start() {
    stream_.reset(arv_camera_create_stream(camera_.get(), nullptr, nullptr, nullptr));
    if (!stream_) return;
    g_object_set(stream_.get(), "frame-retention", 100000, "packet-timeout", 20000, nullptr);
    size_ = arv_camera_get_payload(camera_.get(), nullptr);
    for (int i = 0; i < 3; ++i)
      arv_stream_push_buffer(stream_.get(), arv_buffer_new(size_, nullptr));
    arv_camera_start_acquisition(camera_.get(), nullptr);
  }

  CameraPtr camera_;
  StreamPtr stream_;
  std::size_t size_ = 0;
};

const Solid& pebble() {
  static const Solid solid(ball({2, 0, 40}, 30, 120));
  return solid;
}

std::unique_ptr<RigScanner> started(std::vector<RigFault> faults = {}) {
  auto scanner = RigScanner::start({.object = &pebble(),
                                    .realism = {.seed = 4},
                                    .faults = std::move(faults),
                                    .camera_address = kAddress});
  EXPECT_TRUE(scanner) << scanner.error().message;
  return std::move(*scanner);
}

TEST(Scanner, FramesOverGigeVisionAreTheRenderersBitForBit) {
  const auto scanner = started();
  Client client(kAddress);
  ASSERT_TRUE(client.found());
  EXPECT_EQ(client.serial(), camera_serial(4));
  Renderer renderer(optics_of(4), &pebble(), {.seed = 4});
  for (const double degrees : {0.5, 90.0}) {
    scanner->stage().turned_to(degrees);
    for (const bool laser : {true, false}) {
      scanner->stage().laser(laser);
      const auto frame = client.capture();
      ASSERT_TRUE(frame);
      EXPECT_EQ(*frame, renderer.take({at(degrees, laser)}));
    }
  }
}

TEST(Scanner, ExposureAndRegionAreObeyed) {
  const auto scanner = started();
  scanner->stage().laser(true);
  Client client(kAddress);
  ASSERT_TRUE(client.found());
  client.set_exposure(2000);
  const SensorRegion region{400, 200, 640, 480};
  client.set_region(region);
  const auto frame = client.capture();
  ASSERT_TRUE(frame);
  Renderer renderer(optics_of(4), &pebble(), {.seed = 4});
  EXPECT_EQ(*frame, renderer.take({at(0, true), {.us = 2000}, region}));
}

TEST(Scanner, OneFrameInTwentyLacksPackets) {
  const auto scanner = started({{FaultKind::kLostPackets, 0}});
  Client client(kAddress);
  ASSERT_TRUE(client.found());
  client.set_region({0, 0, 1300, 200});
  int incomplete = 0;
  for (int shot = 0; shot < 60; ++shot)
    incomplete += !client.capture();
  EXPECT_GE(incomplete, 1);
  EXPECT_LE(incomplete, 9);
}

TEST(Scanner, AMissedTriggerIsOneFrameThatNeverComes) {
  const auto scanner = started({{FaultKind::kMissedTrigger, 2}});
  Client client(kAddress);
  ASSERT_TRUE(client.found());
  scanner->stage().turned_to(1);
  EXPECT_TRUE(client.capture());
  scanner->stage().turned_to(2);
  EXPECT_FALSE(client.capture());
  EXPECT_TRUE(client.capture());
  scanner->stage().turned_to(3);
  EXPECT_TRUE(client.capture());
}

TEST(Scanner, AnUnpluggedCameraIsSilentAndComesBackAsItself) {
  const auto scanner = started({{FaultKind::kCameraUnplug, 1}});
  {
    Client client(kAddress);
    ASSERT_TRUE(client.capture());
    scanner->stage().turned_to(0.5);
    int silent = 0;
    while (client.capture() && ++silent < 100) {
    }
    EXPECT_LT(silent, 100);
  }
  for (int tries = 0; tries < 100; ++tries) {
    Client client(kAddress);
    if (!client.found()) continue;
    EXPECT_EQ(client.serial(), camera_serial(4));
    EXPECT_TRUE(client.capture());
    return;
  }
  FAIL() << "it did not come back";
}

TEST(Scanner, DriftMovesTheStripeWithTheStepsAndNotBefore) {
  const std::vector<RigFault> drift{{FaultKind::kDrift, 10}};
  EXPECT_EQ(crept(drift, 10), 0);
  EXPECT_NEAR(crept(drift, 110), 100 * kCreepMm, 1e-12);
  const auto scanner = started(drift);
  Client client(kAddress);
  ASSERT_TRUE(client.found());
  scanner->stage().laser(true);
  const auto before = client.capture();
  for (int turn = 0; turn < 200; ++turn)
    scanner->stage().turned_to(0);
  EXPECT_NE(before, client.capture());
}

TEST(Scanner, ASecondRigNeedsAnAddressOfItsOwn) {
  const auto scanner = started();
  const auto second = RigScanner::start({.camera_address = kAddress});
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().message.find("--address"), std::string::npos);
  const auto nowhere = RigScanner::start({.camera_address = "192.0.2.1"});
  EXPECT_FALSE(nowhere);
}

}  // namespace
}  // namespace vitrine::acquisition::rig::test
