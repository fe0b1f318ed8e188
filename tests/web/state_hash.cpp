// SPDX-License-Identifier: Apache-2.0
// state-hash FILE.pmesh: applies all chunks in the planner's order, with the native build of the
// browser's model class (BrowserModel). Prints the number of faces and the SHA-256 of each state.
// The hash covers lattice positions, faces, colours, displayed positions, normals and texture
// coordinates.
// tests/web/native_equal.mjs compares these lines with those from WebAssembly.
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "codec/base/base_decoder.h"
#include "codec/core/sha256.h"
#include "codec/wasm/browser_model.h"

namespace vitrine {
namespace {

using Bytes = std::vector<std::uint8_t>;

template <class T>
void append(Bytes& out, std::span<const T> values) {
  const auto* begin = reinterpret_cast<const std::uint8_t*>(values.data());
  out.insert(out.end(), begin, begin + values.size_bytes());
}

void print_state(BrowserModel& model) {
  Bytes lattice, faces, colours, positions, normals, coordinates;
  model.display();
  while (model.next_vertices() > 0) {
    append<Vec3i>(lattice, model.lattice_positions());
    append<Colour>(colours, model.attributes().colours);
    append<std::array<float, 3>>(positions, model.positions());
    append<std::array<std::int16_t, 4>>(normals, model.normals());
    append<std::array<float, 2>>(coordinates, model.coordinates());
  }
  while (model.next_faces() > 0)
    append<Triangle>(faces, model.faces());
  Bytes state;
  for (const Bytes& part : {lattice, faces, colours, positions, normals, coordinates})
    state.insert(state.end(), part.begin(), part.end());
  std::printf("%u %s\n", model.refiner().face_count(), to_hex(sha256(state)).c_str());
}

Expected<void> replay(std::span<const std::uint8_t> file) {
  auto opened = BrowserModel::open(file);
  if (!opened) return tl::unexpected(opened.error());
  BrowserModel* const model = opened->get();
  const Manifest& manifest = model->manifest();
  const auto base_bytes = file.subspan(manifest.base_offset, manifest.base_length);
  if (auto fits = model->check_base(base_bytes); !fits) return fits;
  auto base = decode_base(base_bytes, manifest);
  if (!base) return tl::unexpected(base.error());
  const TextureInfo& texture = manifest.texture;
  const auto atlas = file.subspan(texture.atlas_offset, texture.atlas_length);
  if (auto started = model->start(std::move(*base), atlas); !started) return started;
  print_state(*model);
  constexpr std::uint32_t kLevel = 3;
  if (auto wanted = model->want(kLevel, 1e9); !wanted) return tl::unexpected(wanted.error());
  for (int chunk = model->next_chunk(); chunk >= 0; chunk = model->next_chunk()) {
    const ChunkInfo& info = manifest.chunks[static_cast<std::size_t>(chunk)];
    const auto bytes = file.subspan(info.offset, info.length);
    if (auto fits = model->check_chunk(static_cast<std::size_t>(chunk), bytes); !fits) return fits;
    if (auto done = model->apply(static_cast<std::size_t>(chunk), bytes); !done) return done;
    print_state(*model);
  }
  return {};
}

}  // namespace
}  // namespace vitrine

int main(int argc, char** argv) {
  if (argc != 2) return std::fputs("Usage: state-hash FILE.pmesh\n", stderr), 2;
  std::ifstream in(argv[1], std::ios::binary);
  const vitrine::Bytes file{std::istreambuf_iterator<char>(in), {}};
  const auto done = vitrine::replay(file);
  if (done) return 0;
  std::fprintf(stderr, "%s\n", done.error().message.c_str());
  return 1;
}
