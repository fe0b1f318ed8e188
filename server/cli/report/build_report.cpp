// SPDX-License-Identifier: Apache-2.0
#include "server/cli/report/build_report.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "codec/build/open_model.h"
#include "codec/picture/write_picture.h"
#include "codec/render/render.h"
#include "codec/repair/repair.h"
#include "server/cli/report/page.h"

namespace vitrine::server {
namespace {

constexpr std::uint32_t kPictures = 5;
// Side of a picture in pixels: twice its size on the page, for dense displays.
constexpr std::uint32_t kPictureSide = 480;

Vec3 box_size(const TriangleMesh& mesh) {
  Vec3 low = mesh.positions[0], high = low;
  for (const Vec3& p : mesh.positions) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  return high - low;
}

// Returns the levels to draw: the coarsest, the finest, and levels between them whose face counts
// are closest to a geometric series.
std::vector<std::uint32_t> pictured_levels(const std::vector<LevelInfo>& levels) {
  const auto size = [&](std::size_t level) {
    return std::log(static_cast<double>(levels[level].faces));
  };
  const auto last = static_cast<std::uint32_t>(levels.size() - 1);
  std::vector<std::uint32_t> out = {0};
  for (std::uint32_t level = 1; level <= last; ++level) {
    const double next =
        size(0) + (size(last) - size(0)) * static_cast<double>(out.size()) / (kPictures - 1);
    const bool nearest =
        level == last || std::abs(size(level) - next) <= std::abs(size(level + 1) - next);
    if (level == last || (nearest && out.size() + 1 < kPictures)) out.push_back(level);
  }
  return out;
}

Expected<LevelPicture> picture_of(const Refiner& refiner, std::uint32_t level,
                                  const Framing& frame) {
  const Picture picture = render(refiner.display_mesh(), frame);
  auto png = write_png(picture);
  if (!png) return fail(png.error().code, png.error().message + "; leave --report out");
  return LevelPicture{level, picture.width, picture.height, std::move(*png)};
}

Expected<std::vector<LevelPicture>> draw_levels(std::span<const std::uint8_t> pmesh,
                                                const Framing& frame) {
  auto refiner = open_model(pmesh);
  if (!refiner) return tl::unexpected(refiner.error());
  const Manifest& manifest = refiner->manifest();
  const ChunkReader chunks = chunks_of(manifest, pmesh);
  std::vector<LevelPicture> pictures;
  for (const std::uint32_t level : pictured_levels(manifest.levels)) {
    if (auto ok = refine(*refiner, WantLevel{level}, chunks); !ok)
      return tl::unexpected(ok.error());
    auto picture = picture_of(*refiner, level, frame);
    if (!picture) return tl::unexpected(picture.error());
    pictures.push_back(std::move(*picture));
  }
  return pictures;
}

constexpr double kDrawn = 0.1;  // the report's progress once all pictures are drawn

Expected<TriangleMesh> read_original(std::span<const std::uint8_t> input,
                                     const ReadOptions& reading) {
  auto imported = read_mesh(input, reading);
  if (!imported) return tl::unexpected(imported.error());
  auto repaired = repair(*std::move(imported));
  if (!repaired) return tl::unexpected(repaired.error());
  return std::move(repaired->mesh);
}

}  // namespace

Expected<std::string> build_report(std::string_view name, std::span<const std::uint8_t> input,
                                   const ReadOptions& reading, const BuildResult& built,
                                   const ProgressReport& progress) {
  const auto show = [&](double done) { progress("report", done); };
  show(0);
  const auto original = read_original(input, reading);
  if (!original) return tl::unexpected(original.error());
  auto pictures = draw_levels(built.file, frame_around(*original, kPictureSide));
  if (!pictures) return tl::unexpected(pictures.error());
  auto manifest = parse_header(built.file);
  if (!manifest) return tl::unexpected(manifest.error());
  show(kDrawn);
  auto files = single_files(*original, manifest->levels.front().faces, manifest->lattice.bits,
                            [&](double done) { show(std::lerp(kDrawn, 1, done)); });
  return write_page({.name = std::string(name),
                     .input_bytes = input.size(),
                     .size = box_size(*original),
                     .input = built.report.input,
                     .manifest = std::move(*manifest),
                     .sha256 = sha256(built.file),
                     .pictures = std::move(*pictures),
                     .single_files = std::move(files)});
}

}  // namespace vitrine::server
