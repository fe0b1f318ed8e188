// SPDX-License-Identifier: Apache-2.0
#include "codec/appearance/appearance.h"

#include <algorithm>
#include <array>
#include <future>
#include <string>
#include <thread>
#include <vector>

#include "codec/appearance/backdrop.h"
#include "codec/appearance/squared_error.h"
#include "codec/appearance/structural_similarity.h"
#include "codec/appearance/views.h"
#include "codec/render/render.h"
#include "codec/render/vertex_normals.h"

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

ViewDifference compare_view(const ShadedMesh& a, const ShadedMesh& b, const Framing& view) {
  const Picture first = over_grey(a, view), second = over_grey(b, view);
  return {squared_error(first, second), structural_similarity(first, second)};
}

using Differences = std::array<ViewDifference, kViews>;

// Compares the views in several threads; each takes about 100 MB.
Differences compare_views(const ShadedMesh& a, const ShadedMesh& b,
                          const std::array<Framing, kViews>& views) {
  Differences differences;
  const std::size_t threads =
      std::clamp<std::size_t>(std::thread::hardware_concurrency(), 1, kViews);
  std::vector<std::future<void>> tasks;
  for (std::size_t first = 0; first < threads; ++first) {
    tasks.push_back(std::async([&, first] {
      for (std::size_t i = first; i < kViews; i += threads)
        differences[i] = compare_view(a, b, views[i]);
    }));
  }
  for (auto& task : tasks)
    task.get();
  return differences;
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

Expected<Appearance> compare_appearance(const ComparedModel& a, const ComparedModel& b) {
  if (auto ok = check_faces(a.mesh, "A"); !ok) return tl::unexpected(ok.error());
  if (auto ok = check_faces(b.mesh, "B"); !ok) return tl::unexpected(ok.error());
  const auto views = views_around(b.mesh);
  if (!views) return tl::unexpected(views.error());
  return summary_of(compare_views(shaded(a), shaded(b), *views));
}

}  // namespace vitrine::inline codec
