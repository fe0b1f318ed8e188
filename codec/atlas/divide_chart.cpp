// SPDX-License-Identifier: Apache-2.0
#include "codec/atlas/divide_chart.h"

#include <algorithm>

namespace vitrine::inline codec {
namespace {

constexpr std::uint32_t kNoLabel = 0xFFFF'FFFFu;

struct Growth {
  std::vector<std::uint32_t> labels;  // for each face, the seed that reached it first
  std::uint32_t last;                 // the face that was reached last
};

// Breadth-first search over faces, from several seeds at once.
Growth grow(const Chart& chart, std::span<const std::uint32_t> seeds) {
  Growth growth{std::vector<std::uint32_t>(chart.faces.size(), kNoLabel), seeds[0]};
  std::vector<std::uint32_t> queue;
  for (std::uint32_t i = 0; i < seeds.size(); ++i) {
    if (growth.labels[seeds[i]] != kNoLabel) continue;
    growth.labels[seeds[i]] = i;
    queue.push_back(seeds[i]);
  }
  for (std::size_t i = 0; i < queue.size(); ++i) {
    growth.last = queue[i];
    for (const std::uint32_t h : chart.edges[queue[i]]) {
      if (growth.labels[h / 3] != kNoLabel) continue;
      growth.labels[h / 3] = growth.labels[queue[i]];
      queue.push_back(h / 3);
    }
  }
  return growth;
}

}  // namespace

std::vector<std::uint32_t> halves(const Chart& chart) {
  const std::array<std::uint32_t, 1> any{0};
  const std::array<std::uint32_t, 1> end{grow(chart, any).last};
  const std::array<std::uint32_t, 2> ends{end[0], grow(chart, end).last};
  return grow(chart, ends).labels;
}

std::vector<std::uint32_t> with_ring_cut_out(const Chart& chart,
                                             std::span<const std::uint32_t> faces) {
  std::vector<std::uint8_t> touched(chart.positions.size(), 0);
  for (const std::uint32_t f : faces) {
    for (const std::uint32_t w : chart.wedges[f])
      touched[w] = 1;
  }
  std::vector<std::uint32_t> labels;
  for (const Triangle& w : chart.wedges)
    labels.push_back(touched[w[0]] || touched[w[1]] || touched[w[2]] ? 1 : 0);
  const auto cut_out = std::count(labels.begin(), labels.end(), 1u);
  return 2 * static_cast<std::size_t>(cut_out) > labels.size() ? halves(chart) : labels;
}

std::vector<std::uint32_t> each_cut_out(const Chart& chart, std::span<const std::uint32_t> faces) {
  std::vector<std::uint32_t> labels(chart.faces.size(), 0);
  for (const std::uint32_t f : faces)
    labels[f] = 1 + f;
  return labels;
}

}  // namespace vitrine::inline codec
