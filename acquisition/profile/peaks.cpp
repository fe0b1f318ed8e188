// SPDX-License-Identifier: Apache-2.0
#include "acquisition/profile/peaks.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace vitrine::acquisition {
namespace {

constexpr int kSampledRows = 16;    // every 16th row is used to estimate the noise
constexpr double kLeastNoise = .7;  // grey levels: rounding alone causes this much noise
constexpr int kBlock = 64;          // number of bytes compared at once

struct Background {
  int level = 0;      // background of the smoothed difference, in grey levels
  int threshold = 0;  // grey levels above `level` that a peak must exceed
};

const cv::Mat borrow(const Frame& frame) {
  return cv::Mat(
      frame.height, frame.width, CV_8UC1,
      const_cast<std::uint8_t*>(frame.pixels.data()));  // cv::Mat has no constructor for const data
}

cv::Mat smoothed_difference(const Frame& lit, const Frame& dark, double width) {
  cv::Mat difference, smooth;
  cv::subtract(borrow(lit), borrow(dark), difference);
  const int size = 2 * std::max(1, static_cast<int>(std::lround(width))) + 1;
  cv::GaussianBlur(difference, smooth, cv::Size(size, 1), width / 2, 0, cv::BORDER_REPLICATE);
  return smooth;
}

// Returns the median of the smoothed picture, and the threshold for peaks. The noise's standard
// deviation is estimated as the difference between the 84th percentile and the median. The stripe
// covers too little of the picture to affect either value.
Background background(const cv::Mat& smooth, double contrast) {
  std::array<std::size_t, 256> histogram{};
  std::size_t total = 0;
  for (int v = 0; v < smooth.rows; v += kSampledRows) {
    const std::uint8_t* row = smooth.ptr<std::uint8_t>(v);
    for (int u = 0; u < smooth.cols; ++u)
      ++histogram[row[u]];
    total += static_cast<std::size_t>(smooth.cols);
  }
  const auto percentile = [&](double part) {
    std::size_t sum = 0;
    for (int level = 0; level < 256; ++level) {
      sum += histogram[static_cast<std::size_t>(level)];
      if (static_cast<double>(sum) >= part * static_cast<double>(total)) return level;
    }
    return 255;
  };
  const int level = percentile(.5);
  const double noise = std::max(kLeastNoise, static_cast<double>(percentile(.84) - level));
  return {level, static_cast<int>(std::ceil(contrast * noise))};
}

// Returns the largest of `count` values. Works in blocks of constant size, which compilers
// vectorise.
int largest(const std::uint8_t* from, int count) {
  std::array<std::uint8_t, kBlock> top{};
  int u = 0;
  for (; u + kBlock <= count; u += kBlock) {
    for (std::size_t k = 0; k < kBlock; ++k) {
      const std::uint8_t level = from[static_cast<std::size_t>(u) + k];
      top[k] = top[k] < level ? level : top[k];
    }
  }
  int best = *std::max_element(top.begin(), top.end());
  for (; u < count; ++u)
    best = std::max<int>(best, from[u]);
  return best;
}

// Returns the peak at the middle of the plateau that starts at the first maximum.
Peak top_of(const std::uint8_t* row, int from, int to) {
  if (to <= from) return {};
  const int value = largest(row + from, to - from);
  const auto* first = static_cast<const std::uint8_t*>(
      std::memchr(row + from, value, static_cast<std::size_t>(to - from)));
  const int begin = static_cast<int>(first - row);
  int end = begin;
  while (end + 1 < to && row[end + 1] == value)
    ++end;
  return {(begin + end) / 2, value};
}

int least_between(const std::uint8_t* row, const Peak& a, const Peak& b) {
  const auto [from, to] = std::minmax(a.u, b.u);
  return *std::min_element(row + from, row + to);
}

RowPeaks peaks_of(const std::uint8_t* row, int width, int apart, const Background& ground) {
  RowPeaks found;
  const auto add = [&](Peak peak) {
    peak.strength -= ground.level;
    found.peaks[static_cast<std::size_t>(found.count++)] = peak;
  };
  const auto shows = [&](const Peak& p) { return p.strength > ground.level + ground.threshold; };
  const Peak first = top_of(row, 0, width);
  if (!shows(first)) return found;
  add(first);
  const Peak left = top_of(row, 0, first.u - apart),
             right = top_of(row, first.u + apart + 1, width);
  const Peak& second = left.strength > right.strength ? left : right;
  if (!shows(second)) return found;
  // Without a valley between the two peaks, the second peak is only the flank of the first.
  const int valley = least_between(row, first, second);
  if (4 * valley >= 3 * second.strength) return found;
  add(second);
  found.valley = valley - ground.level;
  return found;
}

}  // namespace

std::vector<RowPeaks> find_peaks(const Frame& lit, const Frame& dark,
                                 const StripeOptions& options) {
  if (lit.pixels.empty()) return {};
  const cv::Mat smooth = smoothed_difference(lit, dark, options.width);
  const Background ground = background(smooth, options.contrast);
  const int apart = static_cast<int>(std::ceil(3 * options.width));
  std::vector<RowPeaks> peaks(static_cast<std::size_t>(lit.height));
  for (int v = 0; v < lit.height; ++v)
    peaks[static_cast<std::size_t>(v)] =
        peaks_of(smooth.ptr<std::uint8_t>(v), lit.width, apart, ground);
  return peaks;
}

}  // namespace vitrine::acquisition
