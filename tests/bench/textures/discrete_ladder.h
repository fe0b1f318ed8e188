// SPDX-License-Identifier: Apache-2.0
// The strongest competitor of a progressive model: a ladder of separate files, each with fewer
// faces and smaller pictures. meshoptimizer simplifies the source with its own texture coordinates;
// Draco codes the result; the pictures are WebP files (masked_pictures.h).
#pragma once

#include <vector>

#include "masked_pictures.h"
#include "state_grid.h"
#include "wedge_mesh.h"

namespace vitrine::bench {

// The geometry of a state is one rung of the ladder: a file with 1 % of the faces, up to a file
// with all faces. Its pictures are either the base colours, or the base colours and the normal
// maps, all with the same side. Pictures that the renderer does not show are left out.
class DiscreteLadder {
 public:
  // `bits` is the number of bits per coordinate of the finest rung. Coarser rungs have fewer bits.
  DiscreteLadder(const TexturedModel& model, int bits);

  double ssim(const AppearanceReference& reference, const ModelState& state) const;

  // Returns the bytes of each state if the state is fetched alone, as a single file.
  StateBytes single_files() const;
  // Returns the bytes of each state for a client that first fetches all coarser rungs, and all
  // smaller sizes of the state's pictures.
  StateBytes one_after_the_other() const;

 private:
  using Sizes = std::vector<SizedPicture>;  // in ascending order of size
  std::vector<Picture> pictures_of(std::size_t set) const;
  std::vector<double> picture_bytes(bool has_smaller) const;

  Texturing texturing_;  // texturing of the model without its faces and pictures
  std::vector<FacedMesh> rungs_;
  std::vector<double> rung_bytes_;
  std::vector<std::uint32_t> colours_, normals_;  // indices of the pictures
  std::vector<Sizes> sizes_;                      // sizes of each picture; empty if not shown
  std::size_t steps_ = 0;                         // number of sizes
};

}  // namespace vitrine::bench
