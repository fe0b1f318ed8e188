// SPDX-License-Identifier: Apache-2.0
// What an operator sees while a scan runs: the last frame, the last profile and the growing cloud
// of points. Written by the scan, read from any thread.
#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <vector>

#include "acquisition/frame/frame.h"
#include "acquisition/profile/profile.h"

namespace vitrine {

struct PreviewFrame {
  std::shared_ptr<const Frame>
      frame;      // laser on, at most kPreviewWidth wide; null before the first
  int scale = 1;  // a pixel of it is that many of the camera's on either side
};

inline constexpr int kPreviewWidth = 650;
inline constexpr std::size_t kCloudPoints = 100'000;  // at most

class LivePreview {
 public:
  // For a scan of `steps` profiles, each of which has the same share of the cloud.
  explicit LivePreview(int steps);

  void show(Frame lit);
  void add(const Profile& profile);

  PreviewFrame frame() const;      // made when it is asked for: a scan has no time to lose
  Profile profile() const;         // the last one
  std::size_t cloud_size() const;  // points so far
  // The points of the cloud from number `first` on, mm, in the frame of the object. The cloud only
  // grows, so that a viewer asks for what it does not have. That of a scan which is opened anew
  // lacks the steps that were given up: a viewer of it that held more points starts over.
  std::vector<std::array<float, 3>> cloud_from(std::size_t first) const;

 private:
  const std::size_t share_;  // points of a profile, at most

  mutable std::mutex mutex_;            // of what follows
  std::shared_ptr<const Frame> frame_;  // as large as the camera's
  Profile profile_;
  std::vector<std::array<float, 3>> cloud_;
};

}  // namespace vitrine
