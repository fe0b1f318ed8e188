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

namespace vitrine::acquisition {
namespace {

// Aravis repeats a request that the camera does not answer within 500 ms. The camera may then
// execute both copies. If a call takes longer than kAskedAgain, the request may have been sent
// twice.
constexpr std::chrono::milliseconds kAskedAgain{450};
constexpr int kBuffers = 4;
// Packet size in bytes on the loopback interface, where the path's MTU cannot be probed.
constexpr int kLoopbackPacket = 8192;

struct AravisUnref {
  void operator()(gpointer object) const { g_object_unref(object); }
};
template <class T>
using AravisRef = std::unique_ptr<T, AravisUnref>;

// Holds the error that one call of Aravis reports. Use a new object for each call.
class AravisError {
 public:
  AravisError() = default;
  ~AravisError() { g_clear_error(&error_); }
  AravisError(const AravisError&) = delete;
  AravisError& operator=(const AravisError&) = delete;

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

// A camera whose features have the names of [GenICam].
class AravisCamera final : public Camera {
 public:
  AravisCamera(AravisRef<ArvCamera> camera, std::string name)
      : camera_(std::move(camera)), name_(std::move(name)) {}
  ~AravisCamera() override;

  Expected<void> start(bool loopback);

  const CameraIdentity& identity() const override { return identity_; }
  SensorRegion region() const override { return region_; }
  Expected<void> configure(const CameraSettings& settings) override;
  Expected<Frame> capture() override;

 private:
  Unexpected failed(std::string_view doing, const AravisError& fault) const;
  Expected<void> stop();
  Expected<void> run();
  Expected<void> prepare();
  Expected<void> set_region(SensorRegion wanted);
  Expected<void> set_exposure(double microseconds);
  Expected<void> set_gain(double decibels);
  void drain();
  Expected<void> start_afresh();
  // Triggers the camera once. Returns nullopt if no complete frame arrives, and stores the reason
  // in `missing_`.
  Expected<std::optional<Frame>> shoot();
  std::optional<Frame> frame_in(ArvBuffer& buffer);

  static void on_control_lost(ArvDevice*, gpointer self) {
    static_cast<AravisCamera*>(self)->is_lost_ = true;
  }

  AravisRef<ArvCamera> camera_;
  AravisRef<ArvStream> stream_;
  std::string name_, missing_;
  CameraIdentity identity_;
  SensorRegion region_;
  double exposure_us_ = 0;
  bool is_running_ = false;
  std::atomic<bool> is_lost_{false};  // set by Aravis's heartbeat thread
};

Unexpected AravisCamera::failed(std::string_view doing, const AravisError& fault) const {
  return fail(ErrorCode::kIo,
              fmt::format("{}: cannot {}: {}; check its cable and power, and that no "
                          "other program uses it",
                          name_, doing, fault.text()));
}

Expected<void> AravisCamera::start(bool loopback) {
  AravisError fault;
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
  AravisError ignored;
  g_signal_handlers_disconnect_by_data(arv_camera_get_device(camera_.get()), this);
  if (is_running_ && !is_lost_) arv_camera_stop_acquisition(camera_.get(), ignored.out());
}

Expected<void> AravisCamera::stop() {
  AravisError fault;
  if (std::exchange(is_running_, false)) arv_camera_stop_acquisition(camera_.get(), fault.out());
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
  AravisError fault;
  arv_camera_set_pixel_format(camera_.get(), ARV_PIXEL_FORMAT_MONO_8, fault.out());
  if (fault) return failed("deliver Mono8", fault);
  arv_camera_set_acquisition_mode(camera_.get(), ARV_ACQUISITION_MODE_CONTINUOUS, fault.out());
  if (fault) return failed("run continuously", fault);
  arv_camera_set_trigger(camera_.get(), "Software", fault.out());
  if (fault) return failed("be triggered by software", fault);
  return {};
}

Expected<void> AravisCamera::set_region(SensorRegion wanted) {
  AravisError fault;
  int width = 0, height = 0;
  arv_camera_get_sensor_size(camera_.get(), &width, &height, fault.out());
  if (fault) return failed("report its size", fault);
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
  if (fault) return failed("report its region", fault);
  if (region_ != wanted)
    return fail(ErrorCode::kBadInput,
                fmt::format("{}: region {}x{} at ({}, {}) is possible only as {}x{} at ({}, {}); "
                            "choose that",
                            name_, wanted.width, wanted.height, wanted.x, wanted.y, region_.width,
                            region_.height, region_.x, region_.y));
  return {};
}

Expected<void> AravisCamera::set_exposure(double microseconds) {
  AravisError fault;
  double least = 0, most = 0;
  arv_camera_get_exposure_time_bounds(camera_.get(), &least, &most, fault.out());
  if (fault) return failed("report its exposure times", fault);
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

// Accepts a camera whose gain cannot be set if `decibels` is 0.
Expected<void> AravisCamera::set_gain(double decibels) {
  AravisError fault;
  if (!arv_camera_is_gain_available(camera_.get(), nullptr)) {
    if (decibels == 0) return {};
    return fail(ErrorCode::kBadInput, name_ + ": its gain cannot be set; use 0 dB");
  }
  double least = 0, most = 0;
  arv_camera_get_gain_bounds(camera_.get(), &least, &most, fault.out());
  if (fault) return failed("report its gains", fault);
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
  AravisError fault;
  const std::size_t payload = arv_camera_get_payload(camera_.get(), fault.out());
  if (fault) return failed("report the size of a frame", fault);
  stream_.reset(arv_camera_create_stream(camera_.get(), nullptr, nullptr, fault.out()));
  if (!stream_) return failed("open a stream", fault);
  for (int i = 0; i < kBuffers; ++i)
    arv_stream_push_buffer(stream_.get(), arv_buffer_new_allocate(payload));
  arv_camera_start_acquisition(camera_.get(), fault.out());
  if (fault) return failed("start", fault);
  is_running_ = true;
  return {};
}

// Discards the frames of earlier exposures.
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

// Restarts the stream, so that a late frame of an earlier trigger is not mistaken for the frame of
// the next trigger. Restarting also discards a trigger that the camera has stored and would execute
// when it starts.
Expected<void> AravisCamera::start_afresh() {
  if (auto stopped = stop(); !stopped) return stopped;
  if (auto started = run(); !started) return started;
  const auto timeout = static_cast<std::uint64_t>(exposure_us_ + kStrayTimeout);
  if (ArvBuffer* stray = arv_stream_timeout_pop_buffer(stream_.get(), timeout))
    arv_stream_push_buffer(stream_.get(), stray);
  return {};
}

Expected<std::optional<Frame>> AravisCamera::shoot() {
  AravisError fault;
  drain();
  const auto asked = std::chrono::steady_clock::now();
  arv_camera_software_trigger(camera_.get(), fault.out());
  if (fault) {
    is_lost_ = true;  // the camera did not answer, although Aravis repeated the request
    return failed("trigger", fault);
  }
  if (std::chrono::steady_clock::now() - asked >= kAskedAgain) {
    missing_ = "answers so late that the request was repeated";
    if (auto fresh = start_afresh(); !fresh) return tl::unexpected(fresh.error());
    return std::nullopt;
  }
  const auto timeout = static_cast<std::uint64_t>(exposure_us_ + kFrameTimeout);
  ArvBuffer* buffer = arv_stream_timeout_pop_buffer(stream_.get(), timeout);
  if (buffer != nullptr) {
    auto frame = frame_in(*buffer);
    arv_stream_push_buffer(stream_.get(), buffer);
    return frame;
  }
  missing_ = "no frames";
  if (is_lost_) return std::nullopt;
  if (auto fresh = start_afresh(); !fresh) return tl::unexpected(fresh.error());
  return std::nullopt;
}

Expected<Frame> AravisCamera::capture() {
  for (int i = 0; i < kFrameTries && !is_lost_ && is_running_; ++i) {
    auto frame = shoot();
    if (!frame) return tl::unexpected(frame.error());
    if (*frame) return std::move(**frame);
  }
  if (is_lost_ || !is_running_)
    return fail(ErrorCode::kIo, name_ + ": the connection was lost; check its cable and power");
  return fail(ErrorCode::kIo,
              fmt::format("{}: {} of {} triggers gave {}; check its cable, the network's MTU and "
                          "its load",
                          name_, kFrameTries, kFrameTries, missing_));
}

// Returns Aravis's identifier of the camera with that serial number, or nullopt if there is no such
// camera.
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
    return fail(ErrorCode::kBadInput, "give either the address or the serial number of the camera");
  const bool by_address = !selector.address.empty();
  const std::string name = "camera " + (by_address ? selector.address : selector.serial);
  const auto id = by_address ? std::optional(selector.address) : find_by_serial(selector.serial);
  if (!id) return absent(name, "no camera has that serial number");
  AravisError fault;
  AravisRef<ArvCamera> found(arv_camera_new(id->c_str(), fault.out()));
  if (!found) return absent(name, fault.text());
  auto camera = std::make_unique<AravisCamera>(std::move(found), name);
  if (auto started = camera->start(selector.address.starts_with("127.")); !started)
    return tl::unexpected(started.error());
  return camera;
}

}  // namespace vitrine::acquisition
