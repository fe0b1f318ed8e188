// SPDX-License-Identifier: Apache-2.0
// A monochrome camera that takes one picture at a time on request.
#pragma once

#include <memory>
#include <string>

#include "acquisition/frame/frame.h"
#include "codec/core/expected.h"

namespace vitrine {

struct CameraIdentity {
  std::string vendor, model, serial;
};

struct CameraSettings {
  double exposure_us = 5000;  // > 0
  double gain_db = 0;
  SensorRegion region;  // width or height 0: the whole sensor

  bool operator==(const CameraSettings&) const = default;
};

// How often capture() asks for a frame, how long it waits for each beyond the exposure, and, before
// it asks anew, for one that is under way; microseconds.
inline constexpr int kFrameTries = 3;
inline constexpr double kFramePatience = 500'000, kStrayPatience = 100'000;

// Microseconds, with a camera that answers.
constexpr double longest_capture(double exposure_us) {
  return kFrameTries * (exposure_us + kFramePatience + exposure_us + kStrayPatience);
}

// Owned and called by one thread. An error of any call (kIo) means that the camera is to be closed
// (by destroying this) and opened anew by its serial; errors name the camera and what to check.
class Camera {
 public:
  virtual ~Camera() = default;

  virtual const CameraIdentity& identity() const = 0;
  // The region that is read, never empty.
  virtual SensorRegion region() const = 0;

  // Fails with kBadInput where the camera cannot do that, naming its limits.
  virtual Expected<void> configure(const CameraSettings& settings) = 0;

  // One software trigger, one frame of region()'s size, exposed wholly after the call began. A
  // frame that is incomplete or does not come within the exposure plus 500 ms is asked for anew,
  // three times in all.
  virtual Expected<Frame> capture() = 0;
};

// Which camera: by IP address (GigE Vision; asks nobody else on the network) or by serial number
// (GigE Vision on any interface, USB3 Vision). Exactly one is given.
struct CameraSelector {
  std::string address;
  std::string serial;
};

// Fails with kIo where it is absent, not accessible or held by another program.
Expected<std::unique_ptr<Camera>> open_camera(const CameraSelector& selector);

}  // namespace vitrine
