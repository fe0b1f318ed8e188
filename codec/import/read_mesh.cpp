// SPDX-License-Identifier: Apache-2.0
#include "codec/import/read_mesh.h"

#include <algorithm>
#include <array>

#include "codec/import/formats.h"

namespace vitrine::inline codec {
namespace {

const ImportFormat* format_of(std::span<const std::uint8_t> bytes) {
  const auto* found = std::ranges::find_if(
      kImportFormats, [&](const ImportFormat& format) { return format.recognises(bytes); });
  return found == std::end(kImportFormats) ? nullptr : found;
}

Expected<RawMesh> read_any(std::span<const std::uint8_t> bytes, const ReadOptions& options) {
  if (bytes.empty()) return bad_input("the file is empty; copy or export it again");
  const ImportFormat* format = format_of(bytes);
  if (format == nullptr) {
    return bad_input("not a mesh file that Vitrine reads; convert it to " +
                     std::string(kImportFormatNames));
  }
  return format->read(bytes, options);
}

// Removes a UTF-8 byte order mark, which some editors write at the start of a text.
std::span<const std::uint8_t> without_mark(std::span<const std::uint8_t> bytes) {
  constexpr std::array<std::uint8_t, 3> kMark{0xEF, 0xBB, 0xBF};
  const bool marked =
      bytes.size() > kMark.size() && std::equal(kMark.begin(), kMark.end(), bytes.begin());
  return marked ? bytes.subspan(kMark.size()) : bytes;
}

// Rotates by a quarter turn about x, so that the z axis becomes the y axis. The rotation is exact.
void turn_z_up_to_y(std::vector<Vec3>& positions) {
  for (Vec3& p : positions)
    p = {p.x, p.z, -p.y};
}

}  // namespace

std::string_view stated_unit(std::span<const std::uint8_t> file) {
  const auto bytes = without_mark(file);
  const ImportFormat* format = format_of(bytes);
  return format == nullptr ? std::string_view() : format->unit(bytes);
}

Expected<ImportedMesh> read_mesh(std::span<const std::uint8_t> file, const ReadOptions& options) {
  const auto bytes = without_mark(file);
  auto raw = read_any(bytes, options);
  if (!raw) return tl::unexpected(raw.error());
  auto imported = std::move(*raw).finish(options.limits);
  if (!imported) return imported;
  imported->unit = options.unit.empty() ? stated_unit(file) : options.unit;
  if (options.up == UpAxis::kZ) turn_z_up_to_y(imported->mesh.positions);
  return imported;
}

}  // namespace vitrine::inline codec
