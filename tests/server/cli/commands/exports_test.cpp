// SPDX-License-Identifier: Apache-2.0
// The figures that the program prints for a level must hold for the exported file when other
// software reads it.
#include <algorithm>

#include "support/dense_distance.h"
#include "support/product_names.h"
#include "support/read_export.h"
#include "vitrine_command.h"

namespace vitrine::test {
namespace {

using nlohmann::json;

TriangleMesh read_as(const std::string& bytes, MeshFormat format) {
  return read_export({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, format);
}

// Returns the largest distance from a point of a fine grid on either surface to the other surface.
double farthest(const TriangleMesh& a, const TriangleMesh& b) {
  return std::max(dense_maximum(a, TriangleBvh(b)), dense_maximum(b, TriangleBvh(a)));
}

TEST_F(VitrineCommand, TheErrorOfTheTableBoundsEveryExportOfEveryLevel) {
  const std::string in = write("in.ply", bumpy_ply(2'000));
  const TriangleMesh original = read_as(read("in.ply"), MeshFormat::kPly);
  for (const std::string bits : {"12", "15"}) {
    vitrine_json({"build", in, "-o", path("out.pmesh"), "--bits", bits});
    const json levels = vitrine_json({"info", path("out.pmesh")})["levels"];
    ASSERT_GE(levels.size(), 3u);
    for (const std::string extension : {"ply", "glb", "obj", "stl", "drc", "wrl"}) {
      for (std::size_t level = 0; level < levels.size(); ++level) {
        SCOPED_TRACE(extension + " of level " + std::to_string(level) + ", " + bits + " bits");
        const double stated = levels[level]["max_error"].get<double>();
        const std::string out = "out." + extension;
        vitrine_json({"decode", path("out.pmesh"), "-o", path(out), "--error",
                      levels[level]["max_error"].dump()});
        const TriangleMesh mesh = read_as(read(out), *format_of_extension(extension));
        EXPECT_EQ(mesh.faces.size(), levels[level]["faces"]);
        const double found = farthest(mesh, original);
        EXPECT_LE(found, stated);
        EXPECT_GT(found, 0.5 * stated);
      }
    }
  }
}

}  // namespace
}  // namespace vitrine::test
