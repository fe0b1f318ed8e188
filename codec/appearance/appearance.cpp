// SPDX-License-Identifier: Apache-2.0
#include "codec/appearance/appearance.h"

#include <algorithm>
#include <array>
#include <string>
#include <thread>
#include <vector>

#include "codec/appearance/backdrop.h"
#include "codec/appearance/squared_error.h"
#include "codec/appearance/structural_similarity.h"
#include "codec/appearance/views.h"
#include "codec/core/parallel.h"
#include "codec/mesh/vertex_normals.h"
#include "codec/render/render.h"

namespace vitrine::inline codec {
namespace {

Expected<void> check_faces(const TriangleMesh& mesh, const std::string& name) {
  if (mesh.faces.empty()) {
    return fail(ErrorCode::kBadInput, "mesh " + name + " has no face; give a mesh with a surface");
  }
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (std::ranges::max(mesh.faces[f]) < mesh.positions.size()) continue;
    return fail(ErrorCode::kBadInput, "mesh " + name + ": face " + std::to_string(f) +
                                          " names a vertex that does not exist; export it again");
  }
  return {};
}

ShadedMesh shaded(const ComparedModel& model) {
  return {.mesh = model.mesh, .normals = position_normals(model.mesh), .textures = model.textures};
}

Picture over_grey(const ShadedMesh& model, const Framing& frame) {
  Picture picture = render(model, frame);
  lay_over_grey(picture);
  return picture;
}

struct ViewDifference {
  SquaredError error;
  std::optional<double> similarity;
};

using Differences = std::array<ViewDifference, kViews>;

// Calls visit(i) for each view i, in several threads. Each thread needs about 100 MB of memory to
// render.
template <class Visit>
void for_each_view(const Visit& visit) {
  for_each_index(std::max(1u, std::thread::hardware_concurrency()), kViews, visit);
}

Expected<Appearance> summary_of(const Differences& differences) {
  SquaredError error;
  double similarities = 0;
  int views = 0;
  for (const ViewDifference& view : differences) {
    if (!view.similarity) continue;
    error += view.error;
    similarities += *view.similarity;
    ++views;
  }
  if (views == 0) {
    return fail(ErrorCode::kBadInput, "no face of A or B is visible; give meshes with a surface");
  }
  return Appearance{.psnr = psnr(error), .ssim = similarities / views};
}

}  // namespace

Expected<AppearanceReference> AppearanceReference::of(const ComparedModel& model) {
  if (auto ok = check_faces(model.mesh, "B"); !ok) return tl::unexpected(ok.error());
  const auto views = views_around(model.mesh);
  if (!views) return tl::unexpected(views.error());
  AppearanceReference reference;
  reference.views_ = *views;
  const ShadedMesh mesh = shaded(model);
  for_each_view(
      [&](std::size_t i) { reference.pictures_[i] = over_grey(mesh, reference.views_[i]); });
  return reference;
}

Expected<Appearance> AppearanceReference::compare(const ComparedModel& model) const {
  if (auto ok = check_faces(model.mesh, "A"); !ok) return tl::unexpected(ok.error());
  const ShadedMesh mesh = shaded(model);
  Differences differences;
  for_each_view([&](std::size_t i) {
    const Picture picture = over_grey(mesh, views_[i]);
    differences[i] = {squared_error(picture, pictures_[i]),
                      structural_similarity(picture, pictures_[i])};
  });
  return summary_of(differences);
}

Expected<Appearance> compare_appearance(const ComparedModel& a, const ComparedModel& b) {
  if (auto ok = check_faces(a.mesh, "A"); !ok) return tl::unexpected(ok.error());
  const auto reference = AppearanceReference::of(b);
  if (!reference) return tl::unexpected(reference.error());
  return reference->compare(a);
}

}  // namespace vitrine::inline codec
