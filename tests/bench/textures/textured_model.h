// SPDX-License-Identifier: Apache-2.0
// The models on which textures are measured.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "codec/appearance/appearance.h"
#include "codec/build/build_model.h"
#include "codec/repair/imported_mesh.h"

namespace vitrine::bench {

inline constexpr int kBits = 12;  // bits per coordinate where the sizes of files are compared

struct TexturedModel {
  std::string name;
  ImportedMesh imported;
  // The repaired mesh, without vertex colours, and its texturing. All texture coordinates are in
  // set 0.
  TriangleMesh mesh;
  Texturing texturing;

  // Builds the `.pmesh`. `bits` is the number of bits per coordinate; 0 chooses the number in the
  // same way as `vitrine build`.
  BuildResult build(int bits) const;
  // Builds the `.pmesh` of the same mesh without texturing, with kBits bits per coordinate, and
  // with vertex colours if `has_colours`.
  BuildResult build_untextured(bool has_colours) const;
  // Renders the source with its original pictures.
  AppearanceReference reference() const;
};

// Returns the textured models that `path` names: a file, or all files of a folder, smallest first.
// Leaves out models without a picture of base colours. Also leaves out models with two sets of
// texture coordinates, and prints a message to standard error for each. Throws if no model is left.
std::vector<TexturedModel> read_textured_models(const std::filesystem::path& path);

}  // namespace vitrine::bench
