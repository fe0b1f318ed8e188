// SPDX-License-Identifier: Apache-2.0
#include "picture.h"

#include <fstream>
#include <stdexcept>

#include "codec/picture/write_picture.h"
#include "codec/render/render.h"
#include "support/product_names.h"
#include "value_of.h"

namespace vitrine::bench {

void show(const Options& options, const std::string& name, const TriangleMesh& mesh) {
  if (options.pictures.empty()) return;
  constexpr std::uint32_t kLongest = 800;  // length of the longer side in pixels
  TriangleMesh upright = mesh;             // in a picture, y points upwards
  for (Vec3& p : upright.positions)
    p = {p.x, p.z, -p.y};
  const auto png = value_of(write_png(render(upright, frame_around(upright, kLongest))));
  std::filesystem::create_directories(options.pictures);
  const std::filesystem::path file = options.pictures / (name + ".png");
  std::ofstream out(file, std::ios::binary);
  out.write(reinterpret_cast<const char*>(png.data()), static_cast<std::streamsize>(png.size()));
  if (!out.flush()) throw std::runtime_error("cannot write " + file.string());
}

}  // namespace vitrine::bench
