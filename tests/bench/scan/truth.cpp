// SPDX-License-Identifier: Apache-2.0
#include "truth.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "../codec/models.h"
#include "codec/import/read_mesh.h"
#include "support/product_names.h"

namespace vitrine::bench {

Truth read_truth(const std::filesystem::path& path) {
  const Bytes file = read_file(path);
  auto mesh = read_mesh(file);
  if (!mesh) throw std::runtime_error(path.string() + ": " + mesh.error().message);
  Truth truth{std::move(mesh->mesh), {}};
  // After the header, each vertex has three coordinates as doubles and the flag `seen` in one byte.
  constexpr std::string_view kEnd = "end_header\n";
  constexpr std::ptrdiff_t kRecord = 3 * sizeof(double) + 1;
  const auto header = std::search(file.begin(), file.end(), kEnd.begin(), kEnd.end());
  const auto vertices = static_cast<std::ptrdiff_t>(truth.mesh.positions.size());
  if (file.end() - header < static_cast<std::ptrdiff_t>(kEnd.size()) + kRecord * vertices)
    throw std::runtime_error(path.string() +
                             ": no `seen` flags; write it again with vitrine-rig --write-truth");
  const auto first = header + kEnd.size();
  for (std::ptrdiff_t v = 0; v < vertices; ++v)
    truth.seen.push_back(first[(v + 1) * kRecord - 1]);
  return truth;
}

TriangleMesh seen_part(const Truth& truth) {
  TriangleMesh part{truth.mesh.positions, {}, {}};
  std::ranges::copy_if(truth.mesh.faces, std::back_inserter(part.faces), [&](const Triangle& face) {
    return std::ranges::all_of(face, [&](std::uint32_t v) { return truth.seen[v] != 0; });
  });
  return part;
}

}  // namespace vitrine::bench
