// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <stdexcept>
#include <string>

#include "peer_simplifiers.h"
#include "peers.h"
#include "processor_time.h"
#include "support/product_names.h"
#include "temporary_file.h"

namespace vitrine::bench {
namespace {

template <class T>
void append(Bytes& out, const std::vector<T>& values) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(values.data());
  out.insert(out.end(), bytes, bytes + values.size() * sizeof(T));
}

Bytes flat_file(const MeshoptInput& mesh) {
  Bytes out;
  append(out, std::vector{static_cast<std::uint32_t>(mesh.positions.size() / 3),
                          static_cast<std::uint32_t>(mesh.indices.size())});
  append(out, mesh.positions);
  append(out, mesh.indices);
  return out;
}

template <class T>
std::vector<T> read(std::FILE* in, std::size_t count) {
  std::vector<T> out(count);
  if (std::fread(out.data(), sizeof(T), count, in) != count)
    throw std::runtime_error("meshoptimizer did not run under Node");
  return out;
}

std::vector<Triangle> triangles(const std::vector<std::uint32_t>& indices) {
  std::vector<Triangle> faces;
  for (std::size_t i = 0; i < indices.size(); i += 3)
    faces.push_back({indices[i], indices[i + 1], indices[i + 2]});
  return faces;
}

Simplified read_simplified(std::FILE* in) {
  Simplified out;
  out.seconds = read<float>(in, 1)[0];
  const auto counts = read<std::uint32_t>(in, 2);
  const auto positions = read<float>(in, 3 * std::size_t{counts[0]});
  for (std::size_t i = 0; i < positions.size(); i += 3)
    out.mesh.positions.push_back({positions[i], positions[i + 1], positions[i + 2]});
  out.mesh.faces = triangles(read<std::uint32_t>(in, counts[1]));
  return out;
}

}  // namespace

Simplified simplify_by_meshopt(const TriangleMesh& mesh, std::size_t faces) {
  Simplified out;
  const MeshoptInput flat = meshopt_input(mesh);
  std::vector<std::uint32_t> left;
  out.seconds = seconds([&] { left = meshopt_simplify_to(flat, faces); });
  out.mesh.positions = mesh.positions;
  out.mesh.faces = triangles(left);
  return out;
}

std::vector<Simplified> simplify_by_meshopt_update(const TriangleMesh& mesh,
                                                   const std::vector<std::size_t>& faces) {
  const TemporaryFile file(flat_file(meshopt_input(mesh)));
  std::string command =
      std::string("node '" VITRINE_SOURCE_DIR "/tests/bench/codec/simplify.mjs' ") + file.path();
  for (const std::size_t count : faces)
    command += ' ' + std::to_string(count);
  std::FILE* pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("Node did not start");
  std::vector<Simplified> out;
  for (std::size_t i = 0; i < faces.size(); ++i)
    out.push_back(read_simplified(pipe));
  ::pclose(pipe);
  return out;
}

}  // namespace vitrine::bench
