// SPDX-License-Identifier: Apache-2.0
#include "side_view.h"
#include "support/product_names.h"

#include <cmath>

namespace vitrine::bench {

View side_view(const Manifest& manifest, double side) {
  const double size = manifest.lattice.step * std::exp2(manifest.lattice.bits);
  const auto& box = manifest.tree.nodes[0].box;
  const Vec3 centre =
      manifest.lattice.origin + to_vec3(box.low + box.high) * (manifest.lattice.step / 2);
  return {.camera = {0, 0, -side, 0, 0, 1, 0, 0, side, 0, 0, 0, centre.x + side * size, centre.y,
                     centre.z, 1},
          .field_of_view = 60,
          .width = 1920,
          .height = 1080,
          .pixel_error = 0.01};
}

}  // namespace vitrine::bench
