// SPDX-License-Identifier: Apache-2.0
#include "codec/render/render.h"

#include "codec/mesh/vertex_normals.h"
#include "codec/render/canvas.h"
#include "codec/render/face_opacity.h"
#include "codec/render/face_shader.h"

namespace vitrine::inline codec {
namespace {

void draw(Canvas& canvas, const ShadedMesh& model, const ProjectedMesh& projected) {
  const auto is_opaque = [&](std::uint32_t face) {
    return model.textures == nullptr ||
           model.textures->material(face).alpha_mode == AlphaMode::kOpaque;
  };
  for (std::uint32_t face = 0; face < model.mesh.faces.size(); ++face) {
    const ScreenTriangle triangle = projected.triangle(model.mesh.faces[face]);
    if (is_opaque(face)) {
      canvas.draw(face, triangle, [](const Barycentric&, SamplePosition) { return true; });
    } else {
      canvas.draw(face, triangle,
                  FaceOpacity(model.textures->material(face),
                              model.textures->map(&Material::base_colour_map, face, triangle)));
    }
  }
}

}  // namespace

Picture render(const ShadedMesh& model, const Framing& frame) {
  const ViewAxes axes(frame.toward);
  const Light light(axes);
  const ProjectedMesh projected(model, frame, axes);
  Canvas canvas(frame.width, frame.height);
  draw(canvas, model, projected);
  // Keeps the shader of the last face, because neighbouring samples often lie on the same face.
  std::optional<FaceShader> shader;
  std::uint32_t latest = 0;
  return canvas.develop([&](std::uint32_t face, SamplePosition at) {
    if (!shader || face != latest) shader.emplace(model, projected, light, face);
    latest = face;
    return shader->at(at);
  });
}

Picture render(const TriangleMesh& mesh, const Framing& frame) {
  return render(ShadedMesh{.mesh = mesh, .normals = vertex_normals(mesh)}, frame);
}

}  // namespace vitrine::inline codec
