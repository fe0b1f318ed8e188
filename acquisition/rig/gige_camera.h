// SPDX-License-Identifier: Apache-2.0
// The rig's camera: Aravis' simulated GigE Vision camera, which shows what the renderer draws.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "acquisition/frame/frame.h"
#include "acquisition/rig/sensor.h"
#include "codec/core/expected.h"

namespace vitrine::rig {

struct GigeCameraOptions {
  std::string address = "127.0.0.1";  // of this machine; GigE Vision allows one camera an address
  std::string serial;
};

// What becomes of a frame on its way.
enum class Delivery { kWhole, kLacksPackets, kLost };

struct Exposed {
  Frame frame;
  Delivery delivery = Delivery::kWhole;
};

class GigeCamera {
 public:
  // Called by the camera's own thread for each frame that is triggered.
  using Expose = std::function<Exposed(const Exposure&, const SensorRegion&)>;

  // Fails (kIo) where the address is not this machine's or another camera has it.
  static Expected<std::unique_ptr<GigeCamera>> plug_in(const GigeCameraOptions& options,
                                                       Expose expose);
  ~GigeCamera();
  GigeCamera(const GigeCamera&) = delete;
  GigeCamera& operator=(const GigeCamera&) = delete;

  // As when the cable is pulled: silent, and its settings forgotten. Both return when it is so, and
  // do nothing where it is so already.
  Expected<void> plug_in();
  void unplug();

 private:
  class Plugged;
  GigeCamera(const GigeCameraOptions& options, Expose expose);

  GigeCameraOptions options_;
  Expose expose_;
  std::unique_ptr<Plugged> plugged_;
};

}  // namespace vitrine::rig
