// SPDX-License-Identifier: Apache-2.0
// Chooses the chunk to fetch next. The same code runs in the server, in `vitrine decode` and, as
// WebAssembly, in the browser. It uses no clocks and no I/O.
#pragma once

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "codec/format/manifest.h"
#include "codec/plan/view.h"

namespace vitrine::inline codec {

// Asks for the finest state with at most this many triangles. The last chunk may exceed the number:
// it is fetched completely, and the surplus triangles are then undone (Refiner::undo_to_faces).
struct WantTriangles {
  std::uint64_t triangles;
};
// Asks for the finest state that takes at most this many bytes, including the header and the base
// mesh.
struct WantBytes {
  std::uint64_t bytes;
};
// Asks for the coarsest state whose max_error is at most this, in model units.
struct WantError {
  double error;
};
// Asks for level `level` in all regions of the model.
struct WantLevel {
  std::uint32_t level;
};
// A detail target. A View asks for detail until no visible error exceeds the view's limit. For a
// View, the planner prefers the chunks that remove the most error per byte.
using Want = std::variant<WantTriangles, WantBytes, WantError, WantLevel, View>;

class Planner {
 public:
  explicit Planner(const Manifest& manifest);

  void want(const Want& want);
  void have(std::size_t chunk);  // records a chunk as applied or requested

  // Returns the next chunk to fetch, or nullopt if the detail target is reached. All chunks that
  // must be applied before the returned chunk (see Refiner) have already been passed to have().
  std::optional<std::size_t> next() const;

  // Returns the total size in bytes of the header, the base mesh and the chunks passed to have().
  std::uint64_t bytes_held() const { return bytes_; }

  // Estimates the number of faces after all chunks passed to have() are applied to the base mesh.
  std::uint64_t faces_held() const;

 private:
  bool is_wanted(std::size_t chunk) const;
  double faces_per_vertex(std::uint32_t level) const;

  const Manifest* manifest_;
  Want want_;
  std::vector<std::uint8_t> have_;
  // The members below could be computed from have_. They are stored for speed, because next() may
  // run once for each of 300,000 chunks.
  std::size_t first_missing_ = 0;
  std::uint64_t bytes_;
  double faces_;
};

}  // namespace vitrine::inline codec
