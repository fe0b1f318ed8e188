// SPDX-License-Identifier: Apache-2.0
#include "codec/atlas/pack.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "codec/atlas/footprint.h"

namespace vitrine::inline codec {
namespace {

constexpr std::int32_t kCells = 1024;  // cells per side of the square; more for very many charts
constexpr double kScales = 4096;       // ratio of the largest to the smallest scale tried
constexpr int kTrials = 11;            // number of scales tried

class Packer {
 public:
  Packer(std::span<const ChartTriangles> charts, std::int32_t cells, double gutter)
      : charts_(charts), cells_(cells), gutter_(gutter * cells), place_(charts.size()) {
    for (const ChartTriangles& chart : charts_) {
      boxes_.push_back(chart.empty() ? Box2{} : box_of(chart));
      extent_ = std::max({extent_, boxes_.back().high.x - boxes_.back().low.x,
                          boxes_.back().high.y - boxes_.back().low.y});
    }
    if (extent_ == 0) extent_ = 1;
  }

  // Finds the largest scale that fits, by bisection. Returns nullopt if the charts do not fit even
  // at the smallest scale.
  std::optional<Packing> pack() {
    double high = cells_ / extent_, low = high / kScales;
    std::optional<Packing> best = pack_at(low);
    for (int i = 0; best && i < kTrials; ++i) {
      const double middle = std::sqrt(low * high);
      if (std::optional<Packing> packing = pack_at(middle)) {
        best = std::move(packing);
        low = middle;
      } else {
        high = middle;
      }
    }
    return best;
  }

 private:
  std::optional<Packing> pack_at(double scale) {
    if (!find_footprints(scale)) return std::nullopt;
    std::vector<std::size_t> order(charts_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto by_length = [&](std::size_t i) {
      return footprints_[i].width + footprints_[i].height;
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t i, std::size_t j) { return by_length(i) > by_length(j); });
    if (!place_all(order)) return std::nullopt;
    return packing(scale);
  }

  // Returns false if the charts need more cells than the square has.
  bool find_footprints(double scale) {
    footprints_.clear();
    std::int64_t cells = 0;
    for (std::size_t i = 0; i < charts_.size(); ++i) {
      footprints_.push_back(footprint_of(charts_[i], boxes_[i], scale));
      cells += footprints_.back().cells;
      if (cells > std::int64_t{cells_} * cells_) return false;
    }
    return true;
  }

  bool place_all(std::span<const std::size_t> order) {
    CellSquare square(cells_, gutter_);
    for (const std::size_t i : order) {
      if (footprints_[i].runs.empty()) continue;
      const std::optional<CellPosition> place = square.find(footprints_[i]);
      if (!place) return false;
      square.take(footprints_[i], *place);
      place_[i] = *place;
    }
    return true;
  }

  Packing packing(double scale) const {
    Packing packing{.scale = scale / cells_, .offset = {}};
    for (std::size_t i = 0; i < charts_.size(); ++i) {
      packing.offset.push_back({(place_[i].x - boxes_[i].low.x * scale) / cells_,
                                (place_[i].y - boxes_[i].low.y * scale) / cells_});
    }
    return packing;
  }

  std::span<const ChartTriangles> charts_;
  std::int32_t cells_;
  double gutter_;      // width of the gutter in cells
  double extent_ = 0;  // longest side of any chart's bounding box
  std::vector<Box2> boxes_;
  std::vector<Footprint> footprints_;
  std::vector<CellPosition> place_;
};

}  // namespace

Packing pack(std::span<const ChartTriangles> charts, double gutter) {
  for (std::int32_t cells = kCells;;) {
    if (std::optional<Packing> packing = Packer(charts, cells, gutter).pack()) return *packing;
    gutter /= 2;
    if (gutter * cells < 1) cells *= 2;
  }
}

}  // namespace vitrine::inline codec
