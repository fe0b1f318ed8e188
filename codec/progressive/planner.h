// SPDX-License-Identifier: Apache-2.0
// Chooses which chunk to fetch next. The same code plans in the server, in `vitrine decode` and,
// as WebAssembly, in the browser. Pure: no clocks, no I/O.
#pragma once

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "codec/progressive/manifest.h"
#include "codec/progressive/view.h"

namespace vitrine {

// The finest state not above; the chunk that passes it is fetched whole and shown in part
// (Refiner::undo_to_faces).
struct WantTriangles {
  std::uint64_t triangles;
};
struct WantBytes {
  std::uint64_t bytes;
};  // the finest state not above, header and base included
struct WantError {
  double error;
};  // the coarsest with max_error at most this, model units
struct WantLevel {
  std::uint32_t level;
};  // this level everywhere
// What a camera sees, no more error than it allows: first what takes away most error per byte.
using Want = std::variant<WantTriangles, WantBytes, WantError, WantLevel, View>;

class Planner {
 public:
  explicit Planner(const Manifest& manifest);

  void want(const Want& want);
  void have(std::size_t chunk);  // applied or on its way

  // The next chunk to fetch, or nothing when the want is met. Obeys the region rule.
  std::optional<std::size_t> next() const;

  std::uint64_t bytes_held() const { return bytes_; }  // header, base and chunks of have()

  std::uint64_t faces_held() const;  // real faces of base and chunks of have()

 private:
  bool is_wanted(std::size_t chunk) const;
  double faces_per_vertex(std::uint32_t level) const;

  const Manifest* manifest_;
  Want want_;
  std::vector<std::uint8_t> have_;
  // What follows from have_, kept up to date: next() may come for each of 300,000 chunks.
  std::size_t first_missing_ = 0;
  std::uint64_t bytes_;
  double faces_;
};

}  // namespace vitrine
