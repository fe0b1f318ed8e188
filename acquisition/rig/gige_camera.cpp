// SPDX-License-Identifier: Apache-2.0
#include "acquisition/rig/gige_camera.h"

#include <arpa/inet.h>
#include <arv.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <mutex>

#include "acquisition/rig_optics/optics.h"
#include "codec/files/file_descriptor.h"

namespace vitrine::acquisition::rig {
namespace {

// Share of the packets that a faulty frame loses. With this share, no faulty frame arrives
// complete.
constexpr double kLostShare = 0.05;

// Returns whether the GigE Vision port of the address is free. If another camera uses the port,
// Aravis shares it, and each camera receives only half of the packets.
bool is_free(const std::string& address) {
  sockaddr_in control{};
  control.sin_family = AF_INET;
  control.sin_port = htons(3956);
  if (::inet_pton(AF_INET, address.c_str(), &control.sin_addr) != 1) return false;
  const FileDescriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  return ::bind(socket.get(), reinterpret_cast<const sockaddr*>(&control), sizeof control) == 0;
}

}  // namespace

class GigeCamera::Plugged {
 public:
  Plugged(const GigeCameraOptions& options, const Expose& expose)
      : expose_(expose),
        camera_(
            arv_gv_fake_camera_new_full(options.address.c_str(), options.serial.c_str(), nullptr)) {
    if (!running()) return;
    fake_ = arv_gv_fake_camera_get_fake_camera(camera_);
    write(ARV_FAKE_CAMERA_REGISTER_SENSOR_WIDTH, kSensorWidth);
    write(ARV_FAKE_CAMERA_REGISTER_SENSOR_HEIGHT, kSensorHeight);
    write(ARV_FAKE_CAMERA_REGISTER_WIDTH, kSensorWidth);
    write(ARV_FAKE_CAMERA_REGISTER_HEIGHT, kSensorHeight);
    // In Hz. This is how often the camera polls for a trigger, not the rate of the triggers.
    arv_fake_camera_set_trigger_frequency(fake_, 500);
    arv_fake_camera_set_fill_pattern(fake_, fill, this);
  }
  // Drops a frame whose transmission is in progress.
  ~Plugged() {
    {
      const std::lock_guard lock(mutex_);
      is_leaving_ = true;
      if (camera_ != nullptr) lose(1);
    }
    g_clear_object(&camera_);
  }
  Plugged(const Plugged&) = delete;
  Plugged& operator=(const Plugged&) = delete;

  bool running() const { return camera_ != nullptr && arv_gv_fake_camera_is_running(camera_); }

 private:
  void write(std::uint32_t address, std::uint32_t value) {
    arv_fake_camera_write_register(fake_, address, value);
  }
  int read(std::uint32_t address) const {
    std::uint32_t value = 0;
    arv_fake_camera_read_register(fake_, address, &value);
    return static_cast<int>(std::min<std::uint32_t>(value, 1U << 16));
  }

  static void fill(ArvBuffer* buffer, void* self, std::uint32_t exposure_us, std::uint32_t gain,
                   ArvPixelFormat) {
    static_cast<Plugged*>(self)->fill(buffer, {static_cast<double>(exposure_us), 1.0 * gain});
  }

  void fill(ArvBuffer* buffer, const Exposure& exposure) {
    // Aravis has set the buffer's width and height, but not its size in bytes.
    const int width = arv_buffer_get_image_width(buffer);
    const int height = arv_buffer_get_image_height(buffer);
    std::size_t unset = 0;
    auto* out = static_cast<std::uint8_t*>(
        const_cast<void*>(static_cast<const void*>(arv_buffer_get_data(buffer, &unset))));
    std::fill_n(out, static_cast<std::size_t>(width) * height, std::uint8_t{0});
    const int x = std::min(read(ARV_FAKE_CAMERA_REGISTER_X_OFFSET), kSensorWidth);
    const int y = std::min(read(ARV_FAKE_CAMERA_REGISTER_Y_OFFSET), kSensorHeight);
    const Exposed exposed = expose_(
        exposure, {x, y, std::min(width, kSensorWidth - x), std::min(height, kSensorHeight - y)});
    for (int v = 0; v < exposed.frame.height; ++v) {
      const auto row = exposed.frame.row(v);
      std::copy(row.begin(), row.end(), out + static_cast<std::ptrdiff_t>(v) * width);
    }
    deliver(exposed.delivery);
  }

  void lose(double share) { g_object_set(camera_, "gvsp-lost-ratio", share, nullptr); }

  // Sets how the next frame is transmitted. Only the sending thread may call it.
  void deliver(Delivery delivery) {
    const double lost = delivery == Delivery::kWhole          ? 0
                        : delivery == Delivery::kLacksPackets ? kLostShare
                                                              : 1;
    const std::lock_guard lock(mutex_);
    if (!is_leaving_) lose(lost);
  }

  const Expose& expose_;
  std::mutex mutex_;
  bool is_leaving_ = false;
  ArvGvFakeCamera* camera_ = nullptr;
  ArvFakeCamera* fake_ = nullptr;
};

GigeCamera::GigeCamera(const GigeCameraOptions& options, Expose expose)
    : options_(options), expose_(std::move(expose)) {}

GigeCamera::~GigeCamera() = default;

Expected<std::unique_ptr<GigeCamera>> GigeCamera::plug_in(const GigeCameraOptions& options,
                                                          Expose expose) {
  std::unique_ptr<GigeCamera> camera(new GigeCamera(options, std::move(expose)));
  if (const auto plugged = camera->plug_in(); !plugged) return tl::unexpected(plugged.error());
  return camera;
}

Expected<void> GigeCamera::plug_in() {
  if (plugged_) return {};
  auto plugged = is_free(options_.address) ? std::make_unique<Plugged>(options_, expose_) : nullptr;
  if (!plugged || !plugged->running()) {
    return fail(ErrorCode::kIo,
                fmt::format("camera at {}: no interface has that address, or another camera uses "
                            "it; give --address or --private-network",
                            options_.address));
  }
  plugged_ = std::move(plugged);
  return {};
}

void GigeCamera::unplug() {
  plugged_.reset();
}

}  // namespace vitrine::acquisition::rig
