// SPDX-License-Identifier: Apache-2.0
// Tests that a build reports the parts of a mesh's materials that it cannot keep.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "codec/build/build_model.h"
#include "support/meshes.h"

namespace vitrine::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

// Returns the notes of a build of `mesh` with one material.
std::vector<std::string> notes(TriangleMesh mesh, Texturing texturing) {
  texturing.face_materials.assign(mesh.faces.size(), 0);
  ImportedMesh imported;
  imported.mesh = std::move(mesh);
  imported.texturing = std::move(texturing);
  const auto built = build_model(std::move(imported), {}, {});
  EXPECT_TRUE(built) << built.error().message;
  return built ? built->report.input.repairs : std::vector<std::string>{};
}

TEST(LostMaterials, FactorsOfMaterialsWithoutPicturesAreNamed) {
  const std::string end =
      " of 1 material not carried: no material has a picture; give the materials a texture map";
  EXPECT_THAT(notes(sheet(5, 5), {.materials = {{.metallic = 0.5}}}), Contains("metalness" + end));
  EXPECT_THAT(notes(sheet(5, 5), {.materials = {{.roughness = 0.5}}}), Contains("roughness" + end));
  EXPECT_THAT(notes(sheet(5, 5), {.materials = {{.emission = {0, 1, 0}}}}),
              Contains("emission" + end));
  EXPECT_THAT(
      notes(sheet(5, 5), {.materials = {{.base_colour = {0, 0, 0, 1}, .emission = {0, 1, 0}}}}),
      Not(Contains("emission" + end)));
  EXPECT_THAT(
      notes(sheet(5, 5),
            {.materials = {{.base_colour = {1, 1, 1, 0.5}, .alpha_mode = AlphaMode::kBlend}}}),
      Contains("opacity" + end));
  EXPECT_THAT(notes(sheet(5, 5), {.materials = {{.is_double_sided = true}}}), ::testing::IsEmpty());
}

TEST(LostMaterials, TheTextureOfMoreThan2000ComponentsIsNamed) {
  TriangleMesh scattered;
  for (std::uint32_t i = 0; i < 2'001; ++i) {
    const double x = 2.0 * (i % 50), y = 2.0 * (i / 50);
    scattered.positions.insert(scattered.positions.end(),
                               {{x, y, 0}, {x + 1, y, 0}, {x, y + 1, 0}});
    scattered.faces.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  Texturing texturing{.materials = {{.base_colour_map = TextureMap{}}}, .pictures = {{}}};
  texturing.coordinates[0].resize(scattered.faces.size());
  EXPECT_THAT(
      notes(scattered, texturing),
      Contains(HasSubstr("1 texture left out: the mesh has over 2000 components; join them")));
}

}  // namespace
}  // namespace vitrine::test
