// SPDX-License-Identifier: Apache-2.0
// The rig's camera: Aravis' simulated GigE Vision camera, with images from the renderer.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "acquisition/frame/frame.h"
#include "acquisition/rig_optics/sensor.h"
#include "codec/core/expected.h"

namespace vitrine::acquisition::rig {

struct GigeCameraOptions {
  // An address of this machine. GigE Vision allows only one camera per address.
  std::string address = "127.0.0.1";
  std::string serial;
};

enum class Delivery { kWhole, kLacksPackets, kLost };

struct Exposed {
  Frame frame;
  Delivery delivery = Delivery::kWhole;
};

class GigeCamera {
 public:
  // Renders a triggered frame. The camera's own thread calls it.
  using Expose = std::function<Exposed(const Exposure&, const SensorRegion&)>;

  // Creates the camera and plugs it in. Fails with kIo if the address does not belong to this
  // machine, or if another camera uses it.
  static Expected<std::unique_ptr<GigeCamera>> plug_in(const GigeCameraOptions& options,
                                                       Expose expose);
  ~GigeCamera();
  GigeCamera(const GigeCamera&) = delete;
  GigeCamera& operator=(const GigeCamera&) = delete;

  // Simulate plugging and unplugging the camera's cable. While unplugged, the camera is silent and
  // forgets its settings. Both functions return when the camera is in the requested state.
  Expected<void> plug_in();
  void unplug();

 private:
  class Plugged;
  GigeCamera(const GigeCameraOptions& options, Expose expose);

  GigeCameraOptions options_;
  Expose expose_;
  std::unique_ptr<Plugged> plugged_;
};

}  // namespace vitrine::acquisition::rig
