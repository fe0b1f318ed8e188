// SPDX-License-Identifier: Apache-2.0
#include "meshopt_in_node.h"

#include <cstdio>
#include <stdexcept>
#include <string>

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
                          static_cast<std::uint32_t>(mesh.indices.size()), mesh.attribute_count});
  append(out, mesh.positions);
  append(out, mesh.attributes);
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

SimplifiedArrays read_simplified(std::FILE* in) {
  SimplifiedArrays out;
  out.seconds = read<float>(in, 1)[0];
  const auto counts = read<std::uint32_t>(in, 3);
  out.mesh.attribute_count = counts[2];
  out.mesh.positions = read<float>(in, 3 * std::size_t{counts[0]});
  out.mesh.attributes = read<float>(in, std::size_t{counts[2]} * counts[0]);
  out.mesh.indices = read<std::uint32_t>(in, counts[1]);
  return out;
}

}  // namespace

std::vector<SimplifiedArrays> simplify_in_node(const MeshoptInput& mesh,
                                               const std::vector<std::size_t>& faces) {
  const TemporaryFile file(flat_file(mesh));
  std::string command =
      std::string("node '" VITRINE_SOURCE_DIR "/tests/bench/codec/simplify.mjs' ") + file.path();
  for (const std::size_t count : faces)
    command += ' ' + std::to_string(count);
  std::FILE* pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("Node did not start");
  std::vector<SimplifiedArrays> out;
  for (std::size_t i = 0; i < faces.size(); ++i)
    out.push_back(read_simplified(pipe));
  ::pclose(pipe);
  return out;
}

}  // namespace vitrine::bench
