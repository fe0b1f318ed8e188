// SPDX-License-Identifier: Apache-2.0
// A monochrome camera that takes one picture at a time on request.
#pragma once

#include <memory>
#include <string>

#include "acquisition/frame/frame.h"
#include "codec/core/expected.h"

namespace vitrine::acquisition {

struct CameraIdentity {
  std::string vendor, model, serial;
};

struct CameraSettings {
  double exposure_us = 5000;  // exposure time in microseconds, > 0
  double gain_db = 0;
  SensorRegion region;  // the whole sensor if width or height is 0

  bool operator==(const CameraSettings&) const = default;
};

inline constexpr int kFrameTries = 3;  // capture() requests a frame at most this many times
// Timeouts in microseconds, each added to the exposure time. kFrameTimeout applies to a requested
// frame. kStrayTimeout applies to a late frame of an earlier request, which is discarded.
inline constexpr double kFrameTimeout = 1'000'000, kStrayTimeout = 100'000;

// Returns the longest time, in microseconds, that capture() takes if the camera responds.
constexpr double longest_capture(double exposure_us) {
  return kFrameTries * (exposure_us + kFrameTimeout + exposure_us + kStrayTimeout);
}

// An open camera, owned and called by one thread. After any error (kIo), close the camera by
// destroying this object and open it again by its serial number. Errors name the camera and say
// what to check.
class Camera {
 public:
  virtual ~Camera() = default;

  virtual const CameraIdentity& identity() const = 0;
  // The region of the sensor that is read. Never empty.
  virtual SensorRegion region() const = 0;

  // Applies the settings. Fails with kBadInput if the camera does not support them; the error
  // states the camera's limits.
  virtual Expected<void> configure(const CameraSettings& settings) = 0;

  // Sends one software trigger and returns one frame of region()'s size. The exposure of this frame
  // begins after the call. A frame that is incomplete, or does not arrive within the exposure plus
  // one second, is requested again, up to three times in all.
  virtual Expected<Frame> capture() = 0;
};

// Selects a camera by IP address or by serial number; exactly one must be set. An address selects a
// GigE Vision camera [GigEVision] without a broadcast on the network. A serial number selects a
// GigE Vision camera on any interface, or a USB3 Vision camera [USB3Vision].
struct CameraSelector {
  std::string address;
  std::string serial;
};

// Finds and opens a camera. Fails with kIo if the camera is absent, not accessible or held by
// another program.
Expected<std::unique_ptr<Camera>> open_camera(const CameraSelector& selector);

}  // namespace vitrine::acquisition
