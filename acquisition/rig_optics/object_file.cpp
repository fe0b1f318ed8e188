// SPDX-License-Identifier: Apache-2.0
#include "acquisition/rig_optics/object_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <limits>

#include "codec/import/read_mesh.h"

namespace vitrine::acquisition::rig {
namespace {

Expected<std::vector<std::uint8_t>> contents(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(in), {}};
  if (!in.bad() && !bytes.empty()) return bytes;
  return fail(ErrorCode::kIo,
              fmt::format("{}: cannot be read or is empty; give a mesh file", path.string()));
}

// Rotates a point so that the axis `up` becomes z.
Vec3 stood_up(const std::string& up, const Vec3& p) {
  if (up == "x") return {p.y, p.z, p.x};
  if (up == "-x") return {p.y, -p.z, -p.x};
  if (up == "y") return {p.x, -p.z, p.y};
  if (up == "-y") return {p.x, p.z, -p.y};
  if (up == "-z") return {p.x, -p.y, -p.z};
  return p;
}

struct Extent {
  Vec3 low, high;
};

// Returns the bounds of all points that belong to a face. A file may hold other points too.
Extent box_of(const TriangleMesh& mesh) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Extent box{{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
  for (const Triangle& face : mesh.faces) {
    for (const std::uint32_t v : face) {
      const Vec3& p = mesh.positions[v];
      box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
      box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
    }
  }
  return box;
}

}  // namespace

Expected<TriangleMesh> load(const ObjectFile& placed) {
  const auto bytes = contents(placed.file);
  if (!bytes) return tl::unexpected(bytes.error());
  auto read = read_mesh(*bytes);
  if (!read) return tl::unexpected(read.error());
  TriangleMesh mesh = std::move(read->mesh);
  for (Vec3& p : mesh.positions)
    p = stood_up(placed.up, p);
  const Extent box = box_of(mesh);
  const double height = box.high.z - box.low.z;
  if (!(height > 0)) {
    return fail(ErrorCode::kBadInput,
                fmt::format("{}: has no height along its upward axis; choose another axis by --up",
                            placed.file.string()));
  }
  const Vec3 foot{(box.low.x + box.high.x) / 2, (box.low.y + box.high.y) / 2, box.low.z};
  for (Vec3& p : mesh.positions)
    p = (p - foot) * (placed.height_mm / height);
  return mesh;
}

}  // namespace vitrine::acquisition::rig
