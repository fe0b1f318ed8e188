// SPDX-License-Identifier: Apache-2.0
// Shows a running scan: the last frame, the last profile and the growing point cloud. The scan's
// thread writes them; any thread may read them.
#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <vector>

#include "acquisition/frame/frame.h"
#include "acquisition/profile/profile.h"

namespace vitrine::acquisition {

struct PreviewFrame {
  // The frame taken with laser, at most kPreviewWidth wide. Null before the first frame.
  std::shared_ptr<const Frame> frame;
  int scale = 1;  // number of camera pixels along each side of a preview pixel
};

inline constexpr int kPreviewWidth = 650;
inline constexpr std::size_t kCloudPoints = 100'000;  // upper limit of the cloud's size

class LivePreview {
 public:
  // Previews a scan of `steps` profiles. Each profile gets the same share of the cloud.
  explicit LivePreview(int steps);

  void show(Frame lit);
  void add(const Profile& profile);

  PreviewFrame frame() const;      // shrinks the last frame when called, to keep the scan fast
  Profile profile() const;         // returns the last profile
  std::size_t cloud_size() const;  // returns the number of points so far
  // Returns the cloud's points from index `first` on, in mm in the object's frame. The cloud
  // usually only grows, so a viewer requests only the points that it lacks. It shrinks if a
  // reopened scan has discarded steps. A viewer that then holds more points than the cloud starts
  // over.
  std::vector<std::array<float, 3>> cloud_from(std::size_t first) const;

 private:
  const std::size_t share_;  // largest number of points from one profile

  mutable std::mutex mutex_;            // guards the members below
  std::shared_ptr<const Frame> frame_;  // at the camera's full size
  Profile profile_;
  std::vector<std::array<float, 3>> cloud_;
};

}  // namespace vitrine::acquisition
