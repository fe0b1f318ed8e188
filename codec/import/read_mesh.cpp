// SPDX-License-Identifier: Apache-2.0
#include "codec/import/read_mesh.h"

#include <algorithm>
#include <array>

#include "codec/import/formats.h"
#include "codec/import/other_files.h"
#include "codec/import/packaged_model.h"
#include "codec/package/unpack.h"

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
    if (auto other = describe_other_file(bytes, options.name))
      return bad_input(std::move(other->text));
    if (may_be_cut_stl(bytes)) return read_stl(bytes, options);
    return bad_input("not a mesh file that Vitrine reads; convert it to " +
                     std::string(kImportFormatNames));
  }
  return format->read(bytes, options);
}

Expected<ImportedMesh> read_packaged(std::span<const std::uint8_t> package, ReadOptions options) {
  const auto model = PackagedModel::open(package);
  if (!model) return tl::unexpected(model.error());
  options.beside = model->beside();
  if (!model->name().empty()) options.name = model->name();
  auto imported = read_mesh(model->bytes(), options);
  if (!imported && !model->name().empty()) {
    const auto& [code, message] = imported.error();
    return fail(code, in_quotes(model->name()) + " in the package: " + message);
  }
  if (imported && !model->note().empty()) imported->repairs.push_back(model->note());
  return imported;
}

}  // namespace

std::span<const std::uint8_t> without_mark(std::span<const std::uint8_t> bytes) {
  constexpr std::array<std::uint8_t, 3> kMark{0xEF, 0xBB, 0xBF};
  const bool marked =
      bytes.size() > kMark.size() && std::equal(kMark.begin(), kMark.end(), bytes.begin());
  return marked ? bytes.subspan(kMark.size()) : bytes;
}

std::string_view stated_unit(std::span<const std::uint8_t> file) {
  if (is_package(file)) {
    const auto model = PackagedModel::open(file);
    return model ? stated_unit(model->bytes()) : std::string_view();
  }
  const auto bytes = without_mark(file);
  const ImportFormat* format = format_of(bytes);
  return format == nullptr ? std::string_view() : format->unit(bytes);
}

Expected<ImportedMesh> read_mesh(std::span<const std::uint8_t> file, const ReadOptions& options) {
  if (is_package(file)) return read_packaged(file, options);
  const auto bytes = without_mark(file);
  auto raw = read_any(bytes, options);
  if (!raw) return tl::unexpected(raw.error());
  auto imported = std::move(*raw).finish(options.limits);
  if (!imported) return imported;
  imported->unit = options.unit.empty() ? stated_unit(file) : options.unit;
  if (options.up == UpAxis::kZ) {
    for (Vec3& p : imported->mesh.positions)
      p = turn_z_up_to_y(p);
  }
  return imported;
}

}  // namespace vitrine::inline codec
