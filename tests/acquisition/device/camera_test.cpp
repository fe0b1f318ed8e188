// SPDX-License-Identifier: Apache-2.0
#include "acquisition/device/camera.h"

#include <arv.h>
#include <arvfakecamera.h>
#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <memory>
#include <vector>

#include "acquisition/rig/cable.h"
#include "acquisition/rig/private_network.h"

namespace vitrine::acquisition {
namespace {

// A GigE Vision camera on loopback. All pixels of its n-th frame have the value n.
class SimulatedCamera {
 public:
  explicit SimulatedCamera(const char* address)
      : camera_(arv_gv_fake_camera_new_full(address, "S1", nullptr)) {
    ArvFakeCamera* fake = arv_gv_fake_camera_get_fake_camera(camera_);
    arv_fake_camera_set_trigger_frequency(fake, 500);
    arv_fake_camera_set_fill_pattern(
        fake,
        [](ArvBuffer* buffer, void* count, guint32, guint32, ArvPixelFormat) {
          std::size_t size = 0;
          auto* bytes =
              static_cast<std::uint8_t*>(const_cast<void*>(arv_buffer_get_data(buffer, &size)));
          const int pixels =
              arv_buffer_get_image_width(buffer) * arv_buffer_get_image_height(buffer);
          std::fill_n(bytes, pixels, ++*static_cast<std::atomic<std::uint8_t>*>(count));
        },
        &count_);
  }
  ~SimulatedCamera() { g_object_unref(camera_); }

  bool runs() const { return arv_gv_fake_camera_is_running(camera_) != FALSE; }
  std::uint8_t frames() const { return count_; }
  void write(guint64 address, guint32 value) {
    ArvFakeCamera* fake = arv_gv_fake_camera_get_fake_camera(camera_);
    EXPECT_TRUE(arv_fake_camera_write_register(fake, static_cast<guint32>(address), value));
  }
  // Lets the camera lose the share `part` of all packets. Each run loses the same packets. The
  // camera does not send lost packets again.
  void lose_packets(double part) {
    g_random_set_seed(1);
    g_object_set(camera_, "gvsp-lost-ratio", part, nullptr);
  }

 private:
  std::atomic<std::uint8_t> count_{0};
  ArvGvFakeCamera* camera_;
};

constexpr char kAddress[] = "127.0.0.1";

class CameraTest : public testing::Test {
 protected:
  static void SetUpTestSuite() { ASSERT_TRUE(rig::enter_private_network()); }
};

TEST_F(CameraTest, GivesOneFrameATrigger) {
  const SimulatedCamera simulated(kAddress);
  ASSERT_TRUE(simulated.runs());
  auto camera = open_camera({.address = kAddress});
  ASSERT_TRUE(camera) << camera.error().message;
  EXPECT_EQ((*camera)->identity().serial, "S1");
  ASSERT_TRUE((*camera)->configure({.exposure_us = 1000, .region = {0, 0, 320, 200}}));
  EXPECT_EQ((*camera)->region(), (SensorRegion{0, 0, 320, 200}));
  int last = 0;
  for (int i = 0; i < 20; ++i) {
    const auto frame = (*camera)->capture();
    ASSERT_TRUE(frame) << frame.error().message;
    ASSERT_EQ(frame->pixels.size(), 320u * 200u);
    EXPECT_EQ(frame->pixels.front(), frame->pixels.back());
    EXPECT_GT(frame->pixels.front(), last) << "a new one each time";
    last = frame->pixels.front();
  }
}

TEST_F(CameraTest, IsAskedAnewForFramesThatLostPackets) {
  SimulatedCamera simulated(kAddress);
  auto camera = open_camera({.address = kAddress});
  ASSERT_TRUE(camera) << camera.error().message;
  ASSERT_TRUE((*camera)->configure({.exposure_us = 1000, .region = {0, 0, 320, 200}}));
  simulated.lose_packets(0.005);  // a frame has ten packets, so one frame in twenty is incomplete
  for (int repeated = 0; repeated < 4;) {
    const int before = simulated.frames();
    ASSERT_LT(before, 250) << "no packets are lost";
    const auto frame = (*camera)->capture();
    ASSERT_TRUE(frame) << frame.error().message;
    repeated += simulated.frames() - before - 1;
    const std::vector<std::uint8_t> latest(320u * 200u, simulated.frames());
    ASSERT_TRUE(frame->pixels == latest) << "frame " << int{simulated.frames()} << " is not whole";
  }
}

TEST_F(CameraTest, WhoseFramesAllLosePacketsIsAnError) {
  SimulatedCamera simulated(kAddress);
  auto camera = open_camera({.address = kAddress});
  ASSERT_TRUE(camera) << camera.error().message;
  simulated.lose_packets(0.9);
  const auto frame = (*camera)->capture();
  ASSERT_FALSE(frame);
  EXPECT_NE(frame.error().message.find("3 of 3 triggers gave"), std::string::npos)
      << frame.error().message;
}

// Another client changes the camera's settings. Frames then have another width and height, but the
// same number of bytes.
TEST_F(CameraTest, WhoseFramesHaveAnotherShapeOrFormatIsAnError) {
  SimulatedCamera simulated(kAddress);
  auto camera = open_camera({.address = kAddress});
  ASSERT_TRUE(camera) << camera.error().message;
  ASSERT_TRUE((*camera)->configure({.exposure_us = 1000, .region = {0, 0, 320, 200}}));
  simulated.write(ARV_FAKE_CAMERA_REGISTER_WIDTH, 200);
  simulated.write(ARV_FAKE_CAMERA_REGISTER_HEIGHT, 320);
  auto frame = (*camera)->capture();
  ASSERT_FALSE(frame);
  EXPECT_NE(frame.error().message.find("frames of another size"), std::string::npos)
      << frame.error().message;
  simulated.write(ARV_FAKE_CAMERA_REGISTER_WIDTH, 320);
  simulated.write(ARV_FAKE_CAMERA_REGISTER_HEIGHT, 200);
  simulated.write(ARV_FAKE_CAMERA_REGISTER_PIXEL_FORMAT, ARV_PIXEL_FORMAT_BAYER_GR_8);
  frame = (*camera)->capture();
  ASSERT_FALSE(frame);
  EXPECT_NE(frame.error().message.find("another format than Mono8"), std::string::npos)
      << frame.error().message;
}

TEST_F(CameraTest, IsFoundBySerialNumber) {
  const SimulatedCamera simulated(kAddress);
  const auto camera = open_camera({.serial = "S1"});
  ASSERT_TRUE(camera) << camera.error().message;
  EXPECT_TRUE((*camera)->capture());
  EXPECT_NE(open_camera({.serial = "S2"}).error().message.find("no camera has that serial number"),
            std::string::npos);
}

TEST_F(CameraTest, NamesItsLimits) {
  const SimulatedCamera simulated(kAddress);
  auto camera = open_camera({.address = kAddress});
  ASSERT_TRUE(camera) << camera.error().message;
  const auto wide = (*camera)->configure({.region = {0, 0, 100'000, 10}});
  ASSERT_FALSE(wide);
  EXPECT_EQ(wide.error().code, ErrorCode::kBadInput) << wide.error().message;
  const auto dark = (*camera)->configure({.exposure_us = 1e12});
  ASSERT_FALSE(dark);
  EXPECT_EQ(dark.error().code, ErrorCode::kBadInput) << dark.error().message;
}

TEST_F(CameraTest, ThatIsGoneIsAnErrorAndIsOpenedAnewWhenItIsBack) {
  auto simulated = std::make_unique<SimulatedCamera>(kAddress);
  auto camera = open_camera({.address = kAddress});
  ASSERT_TRUE(camera) << camera.error().message;
  ASSERT_TRUE((*camera)->capture());
  simulated.reset();
  const auto frame = (*camera)->capture();
  ASSERT_FALSE(frame);
  EXPECT_EQ(frame.error().code, ErrorCode::kIo);
  EXPECT_NE(frame.error().message.find("check its cable"), std::string::npos);
  camera->reset();
  const auto absent = open_camera({.address = kAddress});
  ASSERT_FALSE(absent);
  EXPECT_NE(absent.error().message.find("does not answer"), std::string::npos);

  simulated = std::make_unique<SimulatedCamera>(kAddress);
  camera = open_camera({.address = kAddress});
  ASSERT_TRUE(camera) << camera.error().message;
  EXPECT_TRUE((*camera)->capture());
}

// A client repeats a trigger until the camera acknowledges it. A camera that is plugged in again
// during these repeats would execute the trigger.
TEST_F(CameraTest, ThatIsGoneIsTriggeredNoMoreOnceTheRigPutsItsCableBack) {
  auto simulated = std::make_unique<SimulatedCamera>(kAddress);
  auto camera = open_camera({.address = kAddress});
  ASSERT_TRUE(camera) << camera.error().message;
  std::promise<void> gone;
  std::atomic<bool> back{false};
  rig::Cable cable([&] { simulated.reset(), gone.set_value(); }, [&] { back = true; });
  cable.pull();
  gone.get_future().wait();
  EXPECT_FALSE((*camera)->capture());
  EXPECT_FALSE(back) << "it would take the last trigger for one that comes after its start";
}

TEST_F(CameraTest, IsNamedByAddressOrSerialNumber) {
  EXPECT_EQ(open_camera({}).error().code, ErrorCode::kBadInput);
  EXPECT_EQ(open_camera({.address = "127.0.0.1", .serial = "S"}).error().code,
            ErrorCode::kBadInput);
}

}  // namespace
}  // namespace vitrine::acquisition
