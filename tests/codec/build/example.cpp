// SPDX-License-Identifier: Apache-2.0
// Usage: example MESH OUT.glb. Builds a progressive model from a mesh file, and writes a level of
// detail with at most 1,000 triangles.
#include <codec/vitrine.h>

#include <iostream>

template <class T>
T must(vitrine::Expected<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  if constexpr (!std::is_void_v<T>) return std::move(*result);
}

int main(int count, char** arguments) try {
  if (count != 3) throw std::runtime_error("Usage: example MESH OUT.glb");
  const auto bytes = must(vitrine::read_file(arguments[1], 1'000'000'000));
  const auto model = must(vitrine::build_model(bytes, {.bits = 12}));
  auto refiner = must(vitrine::open_model(model.file));
  const auto chunks = vitrine::chunks_of(refiner.manifest(), model.file);
  must(vitrine::refine(refiner, vitrine::WantTriangles{1'000}, chunks));
  const auto mesh = refiner.display_mesh();
  must(vitrine::write_file_atomically(arguments[2],
                                      must(vitrine::write_mesh(mesh, vitrine::MeshFormat::kGlb))));
  std::cout << mesh.faces.size() << " triangles\n";
} catch (const std::exception& fault) {
  std::cerr << fault.what() << '\n';
  return 1;
}
