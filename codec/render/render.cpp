// SPDX-License-Identifier: Apache-2.0
#include "codec/render/render.h"

#include "codec/render/canvas.h"
#include "codec/render/face_opacity.h"
#include "codec/render/face_shader.h"
#include "codec/render/vertex_normals.h"

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
      canvas.draw(
          face, triangle,
          FaceOpacity(model.textures->material(face), model.textures->base_colour(face, triangle)));
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
  std::optional<FaceShader> shader;  // of the latest face: neighbouring samples share it
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
