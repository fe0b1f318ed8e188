// SPDX-License-Identifier: Apache-2.0
// Writes binary glTF 2.0 [glTF] with one mesh of one primitive. Colours are 16-bit values in linear
// light, which restore every sRGB byte exactly. For a mesh far from the origin, positions are
// stored relative to the node's translation, which is decimal text and has more digits than a
// float.
#include "codec/core/srgb.h"
#include "codec/export/far_from_origin.h"
#include "codec/export/file_writer.h"
#include "codec/export/writers.h"

namespace vitrine::inline codec {
namespace {

constexpr std::size_t kPositionBytes = 12, kColourBytes = 8;

template <class Real>
void put_vector(FileWriter& json, const Vec3& v) {
  json.text("["), json.numbers<Real>(v, ","), json.text("]");
}

class GltfJson {
 public:
  // `place` is the position in the scene from which the stored positions are measured. `box` is the
  // bounding box of the stored positions.
  GltfJson(const TriangleMesh& mesh, const Bounds& box, const Vec3& place)
      : mesh_(mesh),
        box_(box),
        place_(place),
        is_coloured_(!mesh.attributes.colours.empty()),
        out_(1024) {}

  FileBytes write() {
    out_.text(
        R"({"asset":{"version":"2.0","generator":"Vitrine"},"scene":0,"scenes":[{"nodes":[0]}],)"
        R"("nodes":[{"mesh":0)");
    if (place_ != Vec3{}) out_.text(R"(,"translation":)"), put_vector<double>(out_, place_);
    out_.text(R"(}],"meshes":[{"primitives":[{"attributes":{"POSITION":0)");
    if (is_coloured_) out_.text(R"(,"COLOR_0":2)");
    out_.text(R"(},"indices":1,"material":0}]}],"materials":[{"doubleSided":true,)"
              R"("pbrMetallicRoughness":{"metallicFactor":0,"roughnessFactor":0.8}}],)");
    accessors();
    views();
    while (out_.size() % 4 != 0)
      out_.text(" ");
    return out_.take();
  }

 private:
  void accessors() {
    out_.text(R"("accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":)");
    out_.number(mesh_.positions.size());
    out_.text(R"(,"min":)"), put_vector<float>(out_, box_.low);
    out_.text(R"(,"max":)"), put_vector<float>(out_, box_.high);
    out_.text(R"(},{"bufferView":1,"componentType":5125,"type":"SCALAR","count":)");
    out_.number(mesh_.faces.size() * 3);
    if (is_coloured_) {
      out_.text(
          R"(},{"bufferView":2,"componentType":5123,"normalized":true,"type":"VEC4","count":)");
      out_.number(mesh_.attributes.colours.size());
    }
    out_.text("}],");
  }

  void view(std::size_t size, std::string_view target) {
    out_.text(at_ == 0 ? "{" : ",{");
    out_.text(R"("buffer":0,"byteOffset":)"), out_.number(at_);
    out_.text(R"(,"byteLength":)"), out_.number(size);
    out_.text(R"(,"target":)"), out_.text(target), out_.text("}");
    at_ += size;
  }

  void views() {
    out_.text(R"("bufferViews":[)");
    view(mesh_.positions.size() * kPositionBytes, "34962");
    view(mesh_.faces.size() * sizeof(Triangle), "34963");
    if (is_coloured_) view(mesh_.attributes.colours.size() * kColourBytes, "34962");
    out_.text(R"(],"buffers":[{"byteLength":)"), out_.number(at_), out_.text("}]}");
  }

  const TriangleMesh& mesh_;
  const Bounds box_;
  const Vec3 place_;
  const bool is_coloured_;
  FileWriter out_;
  std::size_t at_ = 0;
};

std::uint16_t linear_light(std::uint8_t part) {
  return static_cast<std::uint16_t>(srgb_to_linear(part / 255.0) * 65535 + 0.5);
}

}  // namespace

FileBytes write_glb(const TriangleMesh& mesh) {
  const Bounds box = bounds_of(mesh.positions);
  const Vec3 place = is_far_from_origin(box) ? box.centre() : Vec3{};
  const FileBytes json = GltfJson(mesh, {box.low - place, box.high - place}, place).write();
  const std::size_t binary = mesh.positions.size() * kPositionBytes +
                             mesh.faces.size() * sizeof(Triangle) +
                             mesh.attributes.colours.size() * kColourBytes;
  const std::size_t total = 12 + 8 + json.size() + 8 + binary;
  FileWriter out(total);
  out.text("glTF");
  out.put(std::uint32_t{2});
  out.put(static_cast<std::uint32_t>(total));
  out.put(static_cast<std::uint32_t>(json.size()));
  out.text("JSON");
  out.text({reinterpret_cast<const char*>(json.data()), json.size()});
  out.put(static_cast<std::uint32_t>(binary));
  out.text({"BIN\0", 4});
  for (const Vec3& p : mesh.positions)
    out.put_reals(p - place);
  for (const Triangle& face : mesh.faces)
    out.put(face);
  for (const auto& [r, g, b] : mesh.attributes.colours) {
    out.put(std::array<std::uint16_t, 4>{linear_light(r), linear_light(g), linear_light(b), 65535});
  }
  return out.take();
}

}  // namespace vitrine::inline codec
