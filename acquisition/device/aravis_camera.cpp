// SPDX-License-Identifier: Apache-2.0
#include <arv.h>
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

#include "acquisition/device/camera.h"

namespace vitrine {
namespace {

// Aravis asks anew after half a second without an answer, and the camera may obey both.
constexpr std::chrono::milliseconds kAskedAgain{450};
constexpr int kBuffers = 4;
constexpr int kLoopbackPacket = 8192;  // bytes; the path's MTU cannot be probed there

struct Unref {
  void operator()(gpointer object) const { g_object_unref(object); }
};
template <class T>
using Ref = std::unique_ptr<T, Unref>;

// Collects what Aravis reports; one a call.
class Fault {
 public:
  Fault() = default;
  ~Fault() { g_clear_error(&error_); }
  Fault(const Fault&) = delete;
  Fault& operator=(const Fault&) = delete;

  GError** out() {
    g_clear_error(&error_);
    return &error_;
  }
  explicit operator bool() const { return error_ != nullptr; }
  std::string text() const {
    std::string words = error_ != nullptr ? error_->message : "no reason given";
    std::replace(words.begin(), words.end(), '\n', ' ');
    return words;
  }

 private:
  GError* error_ = nullptr;
};

class AravisCamera final : public Camera {
 public:
  AravisCamera(Ref<ArvCamera> camera, std::string name)
      : camera_(std::move(camera)), name_(std::move(name)) {}
  ~AravisCamera() override;

  Expected<void> start(bool loopback);

  const CameraIdentity& identity() const override { return identity_; }
  SensorRegion region() const override { return region_; }
  Expected<void> configure(const CameraSettings& settings) override;
  Expected<Frame> capture() override;

 private:
  Unexpected failed(std::string_view doing, const Fault& fault) const;
  Expected<void> stop();
  Expected<void> run();
  Expected<void> prepare();
  Expected<void> set_region(SensorRegion wanted);
  Expected<void> set_exposure(double microseconds);
  Expected<void> set_gain(double decibels);
  void drain();
  Expected<void> start_afresh();
  // One trigger; nothing where no whole frame came of it, `missing_` tells why.
  Expected<std::optional<Frame>> shoot();
  std::optional<Frame> frame_in(ArvBuffer& buffer);

  static void on_control_lost(ArvDevice*, gpointer self) {
    static_cast<AravisCamera*>(self)->lost_ = true;
  }

  Ref<ArvCamera> camera_;
  Ref<ArvStream> stream_;
  std::string name_, missing_;
  CameraIdentity identity_;
  SensorRegion region_;
  double exposure_us_ = 0;
  bool running_ = false;
  std::atomic<bool> lost_{false};  // set by Aravis's heartbeat thread
};

Unexpected AravisCamera::failed(std::string_view doing, const Fault& fault) const {
  return fail(ErrorCode::kIo,
              fmt::format("{}: cannot {}: {}; check its cable and power, and that no "
                          "other program uses it",
                          name_, doing, fault.text()));
}

Expected<void> AravisCamera::start(bool loopback) {
  Fault fault;
  const auto text = [&](auto get) {
    const char* value = get(camera_.get(), fault.out());
    return std::string(value != nullptr ? value : "");
  };
  identity_ = {.vendor = text(arv_camera_get_vendor_name),
               .model = text(arv_camera_get_model_name),
               .serial = text(arv_camera_get_device_serial_number)};
  if (loopback) {
    arv_camera_gv_set_packet_size_adjustment(camera_.get(), ARV_GV_PACKET_SIZE_ADJUSTMENT_NEVER);
    arv_camera_gv_set_packet_size(camera_.get(), kLoopbackPacket, fault.out());
    if (fault) return failed("set the packet size", fault);
  }
  g_signal_connect(arv_camera_get_device(camera_.get()), "control-lost",
                   G_CALLBACK(&on_control_lost), this);
  return configure({});
}

AravisCamera::~AravisCamera() {
  Fault ignored;
  g_signal_handlers_disconnect_by_data(arv_camera_get_device(camera_.get()), this);
  if (running_ && !lost_) arv_camera_stop_acquisition(camera_.get(), ignored.out());
}

Expected<void> AravisCamera::stop() {
  Fault fault;
  if (std::exchange(running_, false)) arv_camera_stop_acquisition(camera_.get(), fault.out());
  stream_.reset();
  if (fault) return failed("stop", fault);
  return {};
}

Expected<void> AravisCamera::configure(const CameraSettings& settings) {
  if (auto stopped = stop(); !stopped) return stopped;
  if (auto prepared = prepare(); !prepared) return prepared;
  if (auto set = set_region(settings.region); !set) return set;
  if (auto set = set_exposure(settings.exposure_us); !set) return set;
  if (auto set = set_gain(settings.gain_db); !set) return set;
  return start_afresh();
}

Expected<void> AravisCamera::prepare() {
  Fault fault;
  arv_camera_set_pixel_format(camera_.get(), ARV_PIXEL_FORMAT_MONO_8, fault.out());
  if (fault) return failed("deliver Mono8", fault);
  arv_camera_set_acquisition_mode(camera_.get(), ARV_ACQUISITION_MODE_CONTINUOUS, fault.out());
  if (fault) return failed("run continuously", fault);
  arv_camera_set_trigger(camera_.get(), "Software", fault.out());
  if (fault) return failed("be triggered by software", fault);
  return {};
}

Expected<void> AravisCamera::set_region(SensorRegion wanted) {
  Fault fault;
  int width = 0, height = 0;
  arv_camera_get_sensor_size(camera_.get(), &width, &height, fault.out());
  if (fault) return failed("tell its size", fault);
  if (wanted.width == 0 || wanted.height == 0) wanted = {0, 0, width, height};
  if (wanted.x < 0 || wanted.y < 0 || wanted.width < 1 || wanted.height < 1 ||
      wanted.width > width - wanted.x || wanted.height > height - wanted.y)
    return fail(ErrorCode::kBadInput,
                fmt::format("{}: region {}x{} at ({}, {}) is not on the sensor of {}x{} pixels; "
                            "choose one that is",
                            name_, wanted.width, wanted.height, wanted.x, wanted.y, width, height));
  arv_camera_set_region(camera_.get(), wanted.x, wanted.y, wanted.width, wanted.height,
                        fault.out());
  if (fault) return failed("read that region", fault);
  arv_camera_get_region(camera_.get(), &region_.x, &region_.y, &region_.width, &region_.height,
                        fault.out());
  if (fault) return failed("tell its region", fault);
  if (region_ != wanted)
    return fail(ErrorCode::kBadInput,
                fmt::format("{}: region {}x{} at ({}, {}) is possible only as {}x{} at ({}, {}); "
                            "choose that",
                            name_, wanted.width, wanted.height, wanted.x, wanted.y, region_.width,
                            region_.height, region_.x, region_.y));
  return {};
}

Expected<void> AravisCamera::set_exposure(double microseconds) {
  Fault fault;
  double least = 0, most = 0;
  arv_camera_get_exposure_time_bounds(camera_.get(), &least, &most, fault.out());
  if (fault) return failed("tell its exposure times", fault);
  if (!(microseconds >= least && microseconds <= most))
    return fail(ErrorCode::kBadInput,
                fmt::format("{}: exposure {} us is not within {} to {} us; choose one that is",
                            name_, microseconds, least, most));
  if (arv_camera_is_exposure_auto_available(camera_.get(), nullptr))
    arv_camera_set_exposure_time_auto(camera_.get(), ARV_AUTO_OFF, nullptr);
  arv_camera_set_exposure_time(camera_.get(), microseconds, fault.out());
  if (fault) return failed("set its exposure", fault);
  exposure_us_ = microseconds;
  return {};
}

// A camera without gain is good enough where none is asked for.
Expected<void> AravisCamera::set_gain(double decibels) {
  Fault fault;
  if (!arv_camera_is_gain_available(camera_.get(), nullptr)) {
    if (decibels == 0) return {};
    return fail(ErrorCode::kBadInput, name_ + ": it has no gain; ask for 0 dB");
  }
  double least = 0, most = 0;
  arv_camera_get_gain_bounds(camera_.get(), &least, &most, fault.out());
  if (fault) return failed("tell its gains", fault);
  if (!(decibels >= least && decibels <= most))
    return fail(ErrorCode::kBadInput,
                fmt::format("{}: gain {} dB is not within {} to {} dB; choose one that is", name_,
                            decibels, least, most));
  if (arv_camera_is_gain_auto_available(camera_.get(), nullptr))
    arv_camera_set_gain_auto(camera_.get(), ARV_AUTO_OFF, nullptr);
  arv_camera_set_gain(camera_.get(), decibels, fault.out());
  if (fault) return failed("set its gain", fault);
  return {};
}

Expected<void> AravisCamera::run() {
  Fault fault;
  const std::size_t payload = arv_camera_get_payload(camera_.get(), fault.out());
  if (fault) return failed("tell the size of a frame", fault);
  stream_.reset(arv_camera_create_stream(camera_.get(), nullptr, nullptr, fault.out()));
  if (!stream_) return failed("open a stream", fault);
  for (int i = 0; i < kBuffers; ++i)
    arv_stream_push_buffer(stream_.get(), arv_buffer_new_allocate(payload));
  arv_camera_start_acquisition(camera_.get(), fault.out());
  if (fault) return failed("start", fault);
  running_ = true;
  return {};
}

// What was exposed earlier is of no use.
void AravisCamera::drain() {
  while (ArvBuffer* late = arv_stream_try_pop_buffer(stream_.get()))
    arv_stream_push_buffer(stream_.get(), late);
}

std::optional<Frame> AravisCamera::frame_in(ArvBuffer& buffer) {
  if (arv_buffer_get_status(&buffer) != ARV_BUFFER_STATUS_SUCCESS) {
    missing_ = "frames with packets missing";
    return std::nullopt;
  }
  if (arv_buffer_get_payload_type(&buffer) != ARV_BUFFER_PAYLOAD_TYPE_IMAGE ||
      arv_buffer_get_image_pixel_format(&buffer) != ARV_PIXEL_FORMAT_MONO_8) {
    missing_ = "frames of another format than Mono8";
    return std::nullopt;
  }
  std::size_t size = 0;
  const auto* bytes = static_cast<const std::uint8_t*>(arv_buffer_get_data(&buffer, &size));
  const auto pixels = static_cast<std::size_t>(region_.width) * region_.height;
  if (bytes == nullptr || size < pixels || arv_buffer_get_image_width(&buffer) != region_.width ||
      arv_buffer_get_image_height(&buffer) != region_.height) {
    missing_ = "frames of another size";
    return std::nullopt;
  }
  return Frame{.width = region_.width, .height = region_.height, .pixels = {bytes, bytes + pixels}};
}

// Frames of earlier triggers may still come, and would be taken for that of a later one. A camera
// may carry out a trigger of before when it starts, too.
Expected<void> AravisCamera::start_afresh() {
  if (auto stopped = stop(); !stopped) return stopped;
  if (auto started = run(); !started) return started;
  const auto patience = static_cast<std::uint64_t>(exposure_us_ + kStrayPatience);
  if (ArvBuffer* stray = arv_stream_timeout_pop_buffer(stream_.get(), patience))
    arv_stream_push_buffer(stream_.get(), stray);
  return {};
}

Expected<std::optional<Frame>> AravisCamera::shoot() {
  Fault fault;
  drain();
  const auto asked = std::chrono::steady_clock::now();
  arv_camera_software_trigger(camera_.get(), fault.out());
  if (fault) {
    lost_ = true;  // it has been asked several times
    return failed("trigger", fault);
  }
  if (std::chrono::steady_clock::now() - asked >= kAskedAgain) {
    missing_ = "answers so late that it was asked twice";
    if (auto fresh = start_afresh(); !fresh) return Unexpected(fresh.error());
    return std::nullopt;
  }
  const auto patience = static_cast<std::uint64_t>(exposure_us_ + kFramePatience);
  ArvBuffer* buffer = arv_stream_timeout_pop_buffer(stream_.get(), patience);
  if (buffer != nullptr) {
    auto frame = frame_in(*buffer);
    arv_stream_push_buffer(stream_.get(), buffer);
    return frame;
  }
  missing_ = "no frames";
  if (lost_) return std::nullopt;
  if (auto fresh = start_afresh(); !fresh) return Unexpected(fresh.error());
  return std::nullopt;
}

Expected<Frame> AravisCamera::capture() {
  for (int i = 0; i < kFrameTries && !lost_ && running_; ++i) {
    auto frame = shoot();
    if (!frame) return Unexpected(std::move(frame).error());
    if (*frame) return std::move(**frame);
  }
  if (lost_ || !running_)
    return fail(ErrorCode::kIo, name_ + ": control of it is lost; check its cable and power");
  return fail(ErrorCode::kIo,
              fmt::format("{}: {} of {} triggers gave {}; check its cable, the network's MTU and "
                          "its load",
                          name_, kFrameTries, kFrameTries, missing_));
}

// The identifier that Aravis knows the camera with that serial number by.
std::optional<std::string> find_by_serial(const std::string& serial) {
  arv_update_device_list();
  for (unsigned i = 0; i < arv_get_n_devices(); ++i) {
    const char* found = arv_get_device_serial_nbr(i);
    if (found != nullptr && found == serial) return arv_get_device_id(i);
  }
  return std::nullopt;
}

Unexpected absent(const std::string& name, const std::string& why) {
  return fail(
      ErrorCode::kIo,
      fmt::format("{} does not answer: {}; check its cable, power and address, and for USB3 "
                  "Vision that deploy/60-vitrine.rules is installed",
                  name, why));
}

}  // namespace

Expected<std::unique_ptr<Camera>> open_camera(const CameraSelector& selector) {
  if (selector.address.empty() == selector.serial.empty())
    return fail(ErrorCode::kBadInput,
                "a camera is named by its address or by its serial number; give one of them");
  const bool by_address = !selector.address.empty();
  const std::string name = "camera " + (by_address ? selector.address : selector.serial);
  const auto id = by_address ? std::optional(selector.address) : find_by_serial(selector.serial);
  if (!id) return absent(name, "no camera has that serial number");
  Fault fault;
  Ref<ArvCamera> found(arv_camera_new(id->c_str(), fault.out()));
  if (!found) return absent(name, fault.text());
  auto camera = std::make_unique<AravisCamera>(std::move(found), name);
  if (auto started = camera->start(selector.address.starts_with("127.")); !started)
    return Unexpected(started.error());
  return camera;
}

}  // namespace vitrine
