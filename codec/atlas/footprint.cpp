// SPDX-License-Identifier: Apache-2.0
#include "codec/atlas/footprint.h"

#include <algorithm>
#include <bit>

#include "codec/atlas/raster.h"

namespace vitrine::inline codec {
namespace {

// Returns a mask of the cells in [begin, end) that lie in the given word. Word w holds the cells
// from 64 w to 64 w + 63.
std::uint64_t bits_of_word(std::int32_t word, std::int32_t begin, std::int32_t end) {
  const std::int32_t low = std::max(begin - 64 * word, 0), high = std::min(end - 64 * word, 64);
  if (low >= high) return 0;
  return (~std::uint64_t{0} >> (64 - (high - low))) << low;
}

std::vector<CellRun> runs_of(const std::vector<std::uint8_t>& cells, std::int32_t width,
                             std::int32_t height) {
  std::vector<CellRun> runs;
  for (std::int32_t y = 0; y < height; ++y) {
    const std::uint8_t* const row = cells.data() + static_cast<std::size_t>(y) * width;
    for (std::int32_t x = 0; x < width; ++x) {
      if (!row[x]) continue;
      const std::int32_t begin = x;
      while (x < width && row[x])
        ++x;
      runs.push_back({y, begin, x});
    }
  }
  return runs;
}

}  // namespace

Box2 box_of(const ChartTriangles& chart) {
  const auto& first = chart[0][0];
  Box2 box{{first[0], first[1]}, {first[0], first[1]}};
  for (const auto& triangle : chart) {
    for (const auto& [x, y] : triangle) {
      box.low = {std::min(box.low.x, x), std::min(box.low.y, y)};
      box.high = {std::max(box.high.x, x), std::max(box.high.y, y)};
    }
  }
  return box;
}

Footprint footprint_of(const ChartTriangles& chart, const Box2& box, double scale) {
  Footprint footprint;
  footprint.width = exact::floor((box.high.x - box.low.x) * scale) + 1;
  footprint.height = exact::floor((box.high.y - box.low.y) * scale) + 1;
  std::vector<std::uint8_t> cells(static_cast<std::size_t>(footprint.width) * footprint.height);
  for (const auto& triangle : chart) {
    std::array<Vec2, 3> t;
    for (std::size_t k = 0; k < 3; ++k)
      t[k] = (Vec2{triangle[k][0], triangle[k][1]} - box.low) * scale;
    rasterise(t, [&](std::int32_t y, std::int32_t first, std::int32_t last) {
      // Rounding may place the point where an edge crosses the row one cell too far to the side.
      first = std::max(first, 0), last = std::min(last, footprint.width - 1);
      std::uint8_t* const row = cells.data() + static_cast<std::size_t>(y) * footprint.width;
      std::fill(row + first, row + last + 1, std::uint8_t{1});
    });
  }
  footprint.runs = runs_of(cells, footprint.width, footprint.height);
  for (const CellRun& run : footprint.runs)
    footprint.cells += run.end - run.begin;
  return footprint;
}

// Computes `reach_`. Between two cells that are dx columns and dy rows apart, there is a gap of dx
// - 1 columns and dy - 1 rows. Cells whose gap is smaller than the gutter are in reach.
CellSquare::CellSquare(std::int32_t side, double gutter_cells)
    : side_(side),
      words_((side + 63) / 64),
      taken_(static_cast<std::size_t>(side) * words_),
      longest_(side, side) {
  const auto nearest = [](std::int32_t d) { return d > 1 ? d - 1.0 : 0.0; };
  const double limit = gutter_cells * gutter_cells;
  for (std::int32_t dy = 0; nearest(dy) * nearest(dy) < limit; ++dy) {
    std::int32_t dx = 0;
    while (nearest(dx + 1) * nearest(dx + 1) + nearest(dy) * nearest(dy) < limit)
      ++dx;
    reach_.push_back(dx);
  }
  if (reach_.empty()) reach_.push_back(0);
}

bool CellSquare::may_fit(const Footprint& footprint, std::int32_t y) const {
  return std::all_of(footprint.runs.begin(), footprint.runs.end(), [&](const CellRun& run) {
    return run.end - run.begin <= longest_[y + run.row];
  });
}

std::int32_t CellSquare::shift_past_taken(const CellRun& run, const CellPosition& place) const {
  const std::int32_t begin = place.x + run.begin, end = place.x + run.end;
  const std::uint64_t* const row =
      taken_.data() + static_cast<std::size_t>(place.y + run.row) * words_;
  for (std::int32_t word = (end - 1) / 64; word >= begin / 64; --word) {
    const std::uint64_t hit = row[word] & bits_of_word(word, begin, end);
    if (hit != 0) return 64 * word + 63 - std::countl_zero(hit) - begin + 1;
  }
  return 0;
}

std::optional<CellPosition> CellSquare::find(const Footprint& footprint) const {
  std::size_t last_hit = 0;  // the run that blocked the last place; it is tested first
  for (CellPosition place{0, 0}; place.y + footprint.height <= side_; ++place.y) {
    if (!may_fit(footprint, place.y)) continue;
    for (place.x = 0; place.x + footprint.width <= side_;) {
      std::int32_t shift = shift_past_taken(footprint.runs[last_hit], place);
      for (std::size_t i = 0; i < footprint.runs.size() && shift == 0; ++i) {
        shift = shift_past_taken(footprint.runs[i], place);
        if (shift != 0) last_hit = i;
      }
      if (shift == 0) return place;
      place.x += shift;
    }
  }
  return std::nullopt;
}

void CellSquare::take(const Footprint& footprint, const CellPosition& place) {
  const auto reach = static_cast<std::int32_t>(reach_.size()) - 1;
  for (const CellRun& run : footprint.runs) {
    for (std::int32_t dy = -reach; dy <= reach; ++dy) {
      const std::int32_t dx = reach_[std::abs(dy)];
      mark(place.y + run.row + dy, place.x + run.begin - dx, place.x + run.end + dx);
    }
  }
  const std::int32_t top = std::min(place.y + footprint.height + reach, side_);
  for (std::int32_t y = std::max(place.y - reach, 0); y < top; ++y)
    longest_[y] = longest_free_run(y);
}

void CellSquare::mark(std::int32_t y, std::int32_t begin, std::int32_t end) {
  if (y < 0 || y >= side_) return;
  begin = std::max(begin, 0), end = std::min(end, side_);
  for (std::int32_t word = begin / 64; word <= (end - 1) / 64; ++word)
    taken_[static_cast<std::size_t>(y) * words_ + word] |= bits_of_word(word, begin, end);
}

std::int32_t CellSquare::longest_free_run(std::int32_t y) const {
  const std::uint64_t* const row = taken_.data() + static_cast<std::size_t>(y) * words_;
  std::int32_t longest = 0, run = 0;
  for (std::int32_t x = 0; x < side_; ++x) {
    run = (row[x / 64] >> (x % 64) & 1) != 0 ? 0 : run + 1;
    longest = std::max(longest, run);
  }
  return longest;
}

}  // namespace vitrine::inline codec
