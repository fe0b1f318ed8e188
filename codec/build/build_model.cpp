// SPDX-License-Identifier: Apache-2.0
#include "codec/build/build_model.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "codec/build/level_errors.h"
#include "codec/build/model_encoder.h"
#include "codec/build/texture_model.h"
#include "codec/core/linear_colour.h"
#include "codec/mesh/plain_material.h"
#include "codec/repair/raw_mesh.h"
#include "codec/repair/repair.h"
#include "codec/simplify/order_in_space.h"
#include "codec/simplify/simplify.h"

namespace vitrine::inline codec {
namespace {

class Stopwatch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

double median_edge(const TriangleMesh& mesh) {
  constexpr std::size_t kEdges = 30'000;
  std::vector<double> lengths;
  const std::size_t stride = mesh.faces.size() / kEdges + 1;
  for (std::size_t f = 0; f < mesh.faces.size(); f += stride) {
    const Triangle& t = mesh.faces[f];
    lengths.push_back(length(mesh.positions[t[0]] - mesh.positions[t[1]]));
  }
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return *middle;
}

// Returns the number of bits per coordinate of the coarsest lattice whose step is at most 1/32 of
// the median edge length.
int automatic_bits(const TriangleMesh& mesh) {
  const double edge = median_edge(mesh);
  int bits = kMinBits;
  while (bits < kMaxBits && fit_lattice(mesh.positions, bits).step > edge / 32)
    ++bits;
  return bits;
}

// Measured fractions of the build time at which reading, simplification and encoding end. They
// convert the progress of a stage to the progress of the whole build.
constexpr double kRead = 0.02, kSimplified = 0.3, kEncoded = 0.99;
// Share of the encoding time that is the same for every level. The other part of a level's time is
// proportional to the number of vertices that the level adds.
constexpr double kPerLevel = 0.27;

// Returns the number of vertices of the base mesh of a textured model: half a percent of all
// vertices, clamped to the range from 300 to 1,500. With a coarser base mesh, the sizes of texels
// in fine levels would vary more (codec/simplify/TEXTURES.md).
std::uint32_t textured_base_vertices(std::size_t vertices) {
  return static_cast<std::uint32_t>(std::clamp<std::size_t>(vertices / 200, 300, 1500));
}

SimplifyOptions simplify_options(const LatticeMesh& fine, const BuildOptions& options,
                                 bool is_textured, const ProgressReport& progress) {
  // A model this small gets one region. Two regions would cost more bytes, and a viewer that skips
  // one of them would save few bytes.
  const bool few = fine.positions.size() <= 2 * std::size_t{options.region_vertices};
  SimplifyOptions how{.placement = options.placement,
                      .order = options.order,
                      .region_vertices = few ? 0 : options.region_vertices,
                      .omits_components = !is_textured,
                      .threads = options.threads};
  if (is_textured) how.target_vertices = textured_base_vertices(fine.positions.size());
  if (progress)
    how.progress = [&](double done) { progress("simplify", std::lerp(kRead, kSimplified, done)); };
  return how;
}

// `original` is the mesh from which `hierarchy` was built, before its positions were quantised.
Expected<EncodedModel> encode(Hierarchy hierarchy, TriangleMesh original, unsigned threads,
                              const ProgressReport& progress) {
  LevelErrors errors(std::move(original), hierarchy, threads);
  const std::size_t levels = hierarchy.levels.size();
  const auto vertices = static_cast<double>(hierarchy.leaf.size());
  std::size_t level = 0;
  auto model = encode_model(std::move(hierarchy), [&](const MeshState& mesh) {
    errors.add(mesh, level == levels);
    if (level++ == 0 || !progress) return;
    const double share =
        std::lerp(static_cast<double>(mesh.vertex_count()) / vertices,
                  static_cast<double>(level) / static_cast<double>(levels + 1), kPerLevel);
    progress("encode", std::lerp(kSimplified, kEncoded, share));
  });
  if (model) errors.finish(model->manifest);
  return model;
}

// Returns the reason why the textures of a mesh are left out, or an empty text if the model gets
// them.
std::string_view reason_against(const Texturing& texturing, std::uint64_t components) {
  // All components of a textured model are in its base mesh. More components would make the head of
  // the file too large.
  constexpr std::uint64_t kMostComponents = 2'000;
  const auto has_map = [](const Material& material) {
    bool any = false;
    for_each_map(material, [&](const TextureMap&) { any = true; });
    return any;
  };
  if (std::ranges::none_of(texturing.materials, has_map))
    return "no material uses a picture; assign the pictures";
  if (components > kMostComponents) return "the mesh has over 2000 components; join them";
  return {};
}

// Adds a line for each property of the materials, except colour, that is lost because no material
// has a picture.
void report_materials(const Texturing& texturing, std::vector<std::string>& lines) {
  const auto report = [&](const char* what, bool (*has)(const Material&)) {
    const auto count = std::ranges::count_if(texturing.materials, has);
    if (count == 0) return;
    lines.push_back(what + counted(static_cast<std::uint64_t>(count), "material") +
                    " not carried: no material has a picture; give the materials a texture map");
  };
  report("opacity of ", [](const Material& material) {
    return material.alpha_mode == AlphaMode::kBlend && material.base_colour[3] < 1;
  });
  report("metalness of ", [](const Material& material) { return material.metallic > 0; });
  report("roughness of ", [](const Material& material) { return !has_plain_roughness(material); });
  report("emission of ", [](const Material& material) {
    const auto& [r, g, b, opacity] = material.base_colour;
    // The emission of a black material is not lost: it became the vertex colour.
    const bool is_black = to_srgb({r, g, b}) == Colour{0, 0, 0};
    return material.emission != Vec3{} && !is_black;
  });
}

// Decides whether the model gets a texture. If not, clears `texturing` and adds a note about the
// loss. The vertex colours stay.
void choose_texture(Texturing& texturing, BuildReport::Input& input) {
  if (texturing.empty()) return;
  const std::string_view reason = reason_against(texturing, input.components);
  if (reason.empty()) return;
  if (texturing.pictures.empty())
    report_materials(texturing, input.repairs);
  else
    input.repairs.push_back(counted(texturing.pictures.size(), "texture") +
                            " left out: " + std::string(reason));
  texturing = {};
}

// Gives `model` a texture. If that is impossible, adds a note with the reason; the vertex colours
// stay.
void add_texture(const TriangleMesh& mesh, Texturing texturing, EncodedModel& model,
                 std::vector<std::string>& notes) {
  if (texturing.empty()) return;
  const std::string pictures = counted(texturing.pictures.size(), "texture");
  const auto more = texture_model(mesh, std::move(texturing), model);
  if (more) notes.insert(notes.end(), more->begin(), more->end());
  if (!more) notes.push_back(pictures + " left out: " + more.error().message);
}

// Reorders `texturing` after the faces of its mesh were reordered. Face before[i] has become face
// i.
Texturing in_order(Texturing texturing, const std::vector<std::uint32_t>& before) {
  const auto reorder = [&](auto& per_face) {
    if (per_face.empty()) return;
    auto ordered = per_face;
    for (std::size_t f = 0; f < before.size(); ++f)
      ordered[f] = per_face[before[f]];
    per_face = std::move(ordered);
  };
  reorder(texturing.face_materials);
  for (auto& set : texturing.coordinates)
    reorder(set);
  return texturing;
}

// Lets the kernel drop the pages of a memory-mapped file that has been read. For other kinds of
// memory, the call is harmless.
void let_go(std::span<const std::uint8_t> input) {
  const auto page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
  const auto begin = reinterpret_cast<std::uintptr_t>(input.data()) / page * page;
  const auto end = reinterpret_cast<std::uintptr_t>(input.data() + input.size());
  ::madvise(reinterpret_cast<void*>(begin), end - begin, MADV_PAGEOUT);
}

}  // namespace

Expected<BuildResult> build_model(std::span<const std::uint8_t> input, const BuildOptions& options,
                                  const ProgressReport& progress) {
  Stopwatch watch;
  auto imported = read_mesh(input, options.reading);
  if (!imported) return tl::unexpected(imported.error());
  let_go(input);
  const double seconds = watch.lap();
  auto result = build_model(std::move(*imported), options, progress);
  if (result) result->report.seconds.read += seconds;
  return result;
}

Expected<BuildResult> build_model(ImportedMesh imported, const BuildOptions& options,
                                  const ProgressReport& progress) {
  Stopwatch watch;
  BuildResult out;
  BuildReport& report = out.report;
  const std::string unit = imported.unit;
  auto repaired = repair(std::move(imported));
  if (!repaired) return tl::unexpected(repaired.error());
  TriangleMesh& mesh = repaired->mesh;
  report.input = {.vertices = mesh.positions.size(),
                  .faces = mesh.faces.size(),
                  .boundary_edges = repaired->boundary_edges,
                  .components = repaired->components,
                  .repairs = std::move(repaired->repairs)};
  Texturing texturing = in_order(std::move(repaired->texturing), order_in_space(mesh));
  choose_texture(texturing, report.input);
  report.seconds.read = watch.lap();
  if (progress) progress("read", kRead);

  const int bits = options.bits != 0 ? options.bits : automatic_bits(mesh);
  LatticeMesh fine = quantise(mesh, fit_lattice(mesh.positions, bits));
  mesh.faces = {};
  auto hierarchy =
      simplify(fine, simplify_options(fine, options, !texturing.empty(), progress), mesh.positions);
  if (!hierarchy) return tl::unexpected(hierarchy.error());
  report.seconds.simplify = watch.lap();

  mesh.faces = std::move(fine.faces);
  fine = {};
  const TriangleMesh textured = texturing.empty() ? TriangleMesh{} : mesh;
  auto model = encode(std::move(*hierarchy), std::move(mesh), options.threads, progress);
  if (!model) return tl::unexpected(model.error());
  add_texture(textured, std::move(texturing), *model, report.input.repairs);
  report.manifest = std::move(model->manifest);
  report.manifest.unit = unit;
  report.seconds.encode = watch.lap();

  out.file = write_header(report.manifest);
  out.file.insert(out.file.end(), model->body.begin(), model->body.end());
  report.seconds.write = watch.lap();
  if (progress) progress("write", 1.0);
  return out;
}

}  // namespace vitrine::inline codec
