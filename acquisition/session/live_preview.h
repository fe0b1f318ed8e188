// SPDX-License-Identifier: Apache-2.0
// Keeps the last frame, the last profile and the growing point cloud of a running scan for display.
// The scan's thread writes; any thread may read.
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
  int scale = 1;  // camera pixels along each side of a preview pixel
};

inline constexpr int kPreviewWidth = 650;
inline constexpr std::size_t kCloudPoints = 100'000;  // largest number of points in the cloud

class LivePreview {
 public:
  // Prepares the preview of a scan of `steps` profiles. All profiles contribute equally to the
  // cloud.
  explicit LivePreview(int steps);

  void show(Frame lit);
  void add(const Profile& profile);

  PreviewFrame frame() const;      // returns the last frame, shrunk in the caller's thread
  Profile profile() const;         // returns the last profile
  std::size_t cloud_size() const;  // returns the number of points so far
  // Returns the cloud's points from index `first` on, in mm in the object's frame. The cloud
  // usually grows, so a viewer requests only the points that it lacks. The cloud shrinks if a
  // reopened scan has discarded steps. A viewer with more points than cloud_size() must start over.
  std::vector<std::array<float, 3>> cloud_from(std::size_t first) const;

 private:
  const std::size_t share_;  // largest number of points that one profile contributes

  mutable std::mutex mutex_;            // guards the members below
  std::shared_ptr<const Frame> frame_;  // the last frame, at the camera's full size
  Profile profile_;
  std::vector<std::array<float, 3>> cloud_;
};

}  // namespace vitrine::acquisition
