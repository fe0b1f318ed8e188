// SPDX-License-Identifier: Apache-2.0
// The states that a visitor sees while a `.pmesh` is being fetched.
#pragma once

#include <vector>

#include "codec/appearance/appearance.h"
#include "codec/format/manifest.h"
#include "state_grid.h"

namespace vitrine::bench {

// The geometry of a state is a number of chunks, in the order of the file. Its pictures are the
// coarsest picture of base colours, which is in the head, or one picture of base colours and one
// normal map. Pictures that the renderer does not show are left out.
class StreamedModel {
 public:
  explicit StreamedModel(std::vector<std::uint8_t> file);

  const Manifest& manifest() const { return manifest_; }
  double ssim(const AppearanceReference& reference, const ModelState& state) const;
  // Bytes of the file's head, the chunks and the pictures outside the head. A picture replaces
  // smaller pictures of its role, which need not be fetched.
  StateBytes bytes() const;
  // Returns the state with all chunks and the finest pictures.
  ModelState finest() const;
  // Returns the states in the order in which the viewer reaches them if it shows the model as large
  // as a measured view.
  std::vector<ModelState> viewer_path() const;

 private:
  std::vector<std::uint8_t> file_;
  Manifest manifest_;
  std::vector<std::vector<std::size_t>> picture_sets_;  // indices into the manifest's pictures
};

}  // namespace vitrine::bench
