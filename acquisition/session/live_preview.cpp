// SPDX-License-Identifier: Apache-2.0
#include "acquisition/session/live_preview.h"

#include <algorithm>
#include <utility>

namespace vitrine::acquisition {
namespace {

int scale_for(int width) {
  return std::max(1, (width + kPreviewWidth - 1) / kPreviewWidth);
}

// Shrinks a frame. Each pixel gets the brightest value of a square of pixels, so that a thin stripe
// stays visible.
std::shared_ptr<const Frame> shrink(const Frame& frame, int scale) {
  auto small = std::make_shared<Frame>();
  small->width = frame.width / scale, small->height = frame.height / scale;
  small->pixels.resize(std::size_t(small->width) * std::size_t(small->height));
  for (int v = 0; v < small->height * scale; ++v) {
    const auto row = frame.row(v);
    std::uint8_t* out = small->pixels.data() + std::size_t(v / scale) * std::size_t(small->width);
    for (int u = 0; u < small->width * scale; ++u)
      out[u / scale] = std::max(out[u / scale], row[u]);
  }
  return small;
}

}  // namespace

LivePreview::LivePreview(int steps)
    : share_(std::max<std::size_t>(1, kCloudPoints / static_cast<std::size_t>(steps))) {}

void LivePreview::show(Frame lit) {
  auto frame = std::make_shared<const Frame>(std::move(lit));
  const std::lock_guard lock(mutex_);
  frame_ = std::move(frame);
}

void LivePreview::add(const Profile& profile) {
  const std::lock_guard lock(mutex_);
  profile_ = profile;
  const std::size_t stride = profile.points.size() / share_ + 1;
  for (std::size_t i = 0; i < profile.points.size(); i += stride) {
    const Vec3 p = position(profile, profile.points[i]);
    cloud_.push_back({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
  }
}

PreviewFrame LivePreview::frame() const {
  std::shared_ptr<const Frame> large;
  {
    const std::lock_guard lock(mutex_);
    large = frame_;
  }
  if (!large) return {};
  const int scale = scale_for(large->width);
  return {shrink(*large, scale), scale};
}

Profile LivePreview::profile() const {
  const std::lock_guard lock(mutex_);
  return profile_;
}

std::size_t LivePreview::cloud_size() const {
  const std::lock_guard lock(mutex_);
  return cloud_.size();
}

std::vector<std::array<float, 3>> LivePreview::cloud_from(std::size_t first) const {
  const std::lock_guard lock(mutex_);
  return {cloud_.begin() + static_cast<std::ptrdiff_t>(std::min(first, cloud_.size())),
          cloud_.end()};
}

}  // namespace vitrine::acquisition
