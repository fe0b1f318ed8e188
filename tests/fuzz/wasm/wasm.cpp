// SPDX-License-Identifier: Apache-2.0
// Runs the browser's model class on hostile bytes, with the calls that a page makes. The seeds are
// those of the decode fuzzer. Their base mesh is raw instead of a Draco buffer, so that most
// mutations reach the layers; the base fuzzer reads Draco buffers. The hash of the header is
// corrected, and other hashes are ignored. The last bytes of the input also determine a detail
// request.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "../bounded.h"
#include "../checks.h"
#include "../decode/decoding_bound.h"
#include "../decode/raw_base.h"
#include "codec/wasm/browser_model.h"
#include "support/sealed.h"

namespace vitrine {
namespace {

using fuzz::part;
using fuzz::require;

// Value of the argument `kind` by which BrowserModel::want() requests a level.
constexpr std::uint32_t kLevel = 3;

template <class T>
T last_bytes(std::span<const std::uint8_t> bytes) {
  T value{};
  const std::size_t size = std::min(sizeof value, bytes.size());
  std::memcpy(&value, bytes.data() + bytes.size() - size, size);
  return value;
}

struct Counts {
  std::uint32_t vertices = 0, faces = 0;
};

// Takes all arrays of the displayed surface from the model, and checks that a GPU can draw them.
Counts hand_out(BrowserModel& model) {
  Counts out;
  model.display();
  while (const std::uint32_t count = model.next_vertices()) {
    out.vertices += count;
    require(model.positions().size() == count && model.normals().size() == count);
    require(model.attributes().fit(count));
    for (const auto& at : model.coordinates())
      require(std::ranges::all_of(at, [](float x) { return std::isfinite(x); }));
    for (const auto& p : model.positions())
      require(std::ranges::all_of(p, [](float x) { return std::isfinite(x); }));
  }
  while (const std::uint32_t count = model.next_faces()) {
    out.faces += count;
    for (const Triangle& f : model.faces())
      require(std::ranges::all_of(f, [&](VertexId v) { return v < out.vertices; }));
  }
  return out;
}

void expect_whole_surface(BrowserModel& model) {
  const Counts out = hand_out(model);
  require(out.vertices == model.displayed_vertices());
  require(out.vertices >= model.refiner().vertex_count());
  require(out.faces == model.refiner().face_count());
}

// Applies the chunks that the detail request needs. Returns false if the model refuses a chunk as
// damaged. The model must then refuse all chunks until the next detail request.
bool fetch(BrowserModel& model, std::span<const std::uint8_t> bytes) {
  for (int next = model.next_chunk(); next >= 0; next = model.next_chunk()) {
    const auto chunk = static_cast<std::size_t>(next);
    const ChunkInfo& info = model.manifest().chunks[chunk];
    if (!model.apply(chunk, part(bytes, info.offset, info.length))) {
      require(!model.apply(chunk, {}));
      return false;
    }
  }
  model.trim();
  return true;
}

void visit(std::span<const std::uint8_t> bytes) {
  auto opened = BrowserModel::open(bytes);
  if (!opened) return;
  BrowserModel* const model = opened->get();
  const Manifest& manifest = model->manifest();
  const TextureInfo& texture = manifest.texture;
  const std::size_t for_texture = texture.empty() ? 0 : 8 + 4 * texture.pictures.size();
  require(model->summary().size() ==
          11 + 5 * manifest.levels.size() + 4 * manifest.chunks.size() + for_texture);
  require(!model->check_chunk(manifest.chunks.size(), {}));
  require(!model->check_picture(texture.pictures.size(), {}));
  const auto base = part(bytes, manifest.base_offset, manifest.base_length);
  const auto atlas = part(bytes, texture.atlas_offset, texture.atlas_length);
  if (!model->start(fuzz::read_raw_base(base, manifest), atlas)) return;
  expect_whole_surface(*model);
  const auto kind = last_bytes<std::uint8_t>(bytes) % kLevel;
  for (const auto& [how, much] :
       {std::pair{kind, last_bytes<double>(bytes)}, {kLevel, 1.0}, {kLevel, 1e9}}) {
    require(model->want(how, much).has_value());
    if (fetch(*model, bytes)) {
      expect_whole_surface(*model);
    } else {
      hand_out(*model);
    }
    require(model->bytes_held() >= static_cast<double>(manifest.head_bytes()));
  }
}

}  // namespace
}  // namespace vitrine

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = vitrine::test::sealed({data, size});
  vitrine::fuzz::bounded(vitrine::fuzz::decoding_bound(file), size, [&] { vitrine::visit(file); });
  return 0;
}
