// SPDX-License-Identifier: Apache-2.0
// Finds the cells of a grid that a chart touches, and free places for charts in a square of cells.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "codec/atlas/pack.h"
#include "codec/core/vec2.h"

namespace vitrine::inline codec {

// The cells of one row from `begin` up to but excluding `end`.
struct CellRun {
  std::int32_t row, begin, end;
};

struct Footprint {
  std::int32_t width = 0, height = 0;
  std::int64_t cells = 0;
  std::vector<CellRun> runs;  // sorted by row, then from left to right
};

struct Box2 {
  Vec2 low, high;
};
// Returns the bounding box of a chart that has at least one triangle.
Box2 box_of(const ChartTriangles& chart);

// Returns the footprint of a chart at `scale` cells per unit. The lower left corner of `box`, the
// chart's bounding box, is the corner of cell (0, 0). The box must be at most 2^20 cells wide and
// high.
Footprint footprint_of(const ChartTriangles& chart, const Box2& box, double scale);

struct CellPosition {
  std::int32_t x, y;
};

// A square of cells that keeps footprints apart by a gutter.
class CellSquare {
 public:
  CellSquare(std::int32_t side, double gutter_cells);

  // Returns the lowest free place for a footprint. Among equally low places, returns the leftmost.
  // Returns nullopt if no place is free.
  std::optional<CellPosition> find(const Footprint& footprint) const;
  // Marks the cells of a footprint as taken, and also all cells closer to it than the gutter width.
  void take(const Footprint& footprint, const CellPosition& place);

 private:
  bool may_fit(const Footprint& footprint, std::int32_t y) const;
  // Returns how many cells the run must move to the right to pass its last taken cell. Returns 0 if
  // no cell of the run is taken.
  std::int32_t shift_past_taken(const CellRun& run, const CellPosition& place) const;
  void mark(std::int32_t y, std::int32_t begin, std::int32_t end);
  std::int32_t longest_free_run(std::int32_t y) const;

  std::int32_t side_, words_;
  // For each distance in rows: how many cells to the side the gutter reaches.
  std::vector<std::int32_t> reach_;
  std::vector<std::uint64_t> taken_;   // one bit per cell, words_ words per row
  std::vector<std::int32_t> longest_;  // for each row, the length of its longest free run
};

}  // namespace vitrine::inline codec
