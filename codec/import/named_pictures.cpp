// SPDX-License-Identifier: Apache-2.0
#include "codec/import/named_pictures.h"

#include <algorithm>
#include <cmath>

#include "codec/import/obj_library.h"
#include "codec/picture/decode_picture.h"
#include "codec/picture/sample.h"
#include "codec/repair/raw_mesh.h"

namespace vitrine::inline codec {
namespace {

// Whether the mean colour of a sample of pixels is about (128, 128, 255), as in normal maps.
bool is_light_blue(const Picture& picture) {
  constexpr std::uint32_t kGrid = 32;
  std::array<double, 3> sums{};
  for (std::uint32_t i = 0; i < kGrid * kGrid; ++i) {
    const auto at = [](std::uint32_t k, std::uint32_t size) {
      return static_cast<std::uint32_t>((2 * k + 1) * std::uint64_t{size} / (2 * kGrid));
    };
    const Colour colour = picture.at(at(i % kGrid, picture.width), at(i / kGrid, picture.height));
    for (std::size_t k = 0; k < 3; ++k)
      sums[k] += colour[k];
  }
  const auto mean = [&](std::size_t k) { return sums[k] / (kGrid * kGrid); };
  return std::abs(mean(0) - 128) < 40 && std::abs(mean(1) - 128) < 40 && mean(2) > 190;
}

}  // namespace

NamedPictures::Source NamedPictures::source_of(const StatedPath& path) const {
  auto found = find_companion(companions_, path);
  // Some programs write a comment after the name. A name itself may contain " #", so the text after
  // it is removed only if the whole text names no picture.
  if (const std::size_t comment = path.path.find(" #"); !found && comment != path.path.npos)
    found = find_companion(companions_,
                           {without_end_blanks(path.path.substr(0, comment)), path.folder});
  // Other programs write the name as in a URI.
  if (!found && path.path.find('%') != path.path.npos)
    found = find_companion(companions_, {percent_decoded(path.path), path.folder});
  if (found) return {(*found)->first, (*found)->second};
  // no companion has this key, because keys do not end with a slash
  return {companion_key(path.path) + '/', tl::unexpected(found.error())};
}

Expected<Picture> NamedPictures::decode(const Source& source) {
  if (!source.bytes) return tl::unexpected(source.bytes.error());
  return decode_picture(*source.bytes, pixels_left_);
}

void NamedPictures::note_fault(const Source& source, const StatedPath& path,
                               const std::string& fault) {
  faults_.try_emplace(source.key, PictureFault{as_utf8(path.path), fault});
}

const Picture* NamedPictures::find(const StatedPath& path) {
  const Source source = source_of(path);
  const auto [it, is_new] = decoded_.try_emplace(source.key);
  if (is_new) {
    auto picture = decode(source);
    if (picture) {
      pixels_left_ -= std::uint64_t{picture->width} * picture->height;
      it->second = *std::move(picture);
    } else {
      note_fault(source, path, picture.error().message);
    }
  }
  return it->second ? &*it->second : nullptr;
}

std::optional<std::uint32_t> NamedPictures::carry(const StatedPath& path) {
  const Source source = source_of(path);
  if (faults_.contains(source.key)) return std::nullopt;
  const auto index =
      source.bytes ? carried_.add(std::string(path.path), *source.bytes, limits_.picture_bytes)
                   : Expected<std::uint32_t>(tl::unexpected(source.bytes.error()));
  if (index) return *index;
  note_fault(source, path, index.error().message);
  return std::nullopt;
}

bool NamedPictures::shows_normals(const StatedPath& path) {
  const Source source = source_of(path);
  const auto [it, is_new] = shows_normals_.try_emplace(source.key, false);
  if (is_new) {
    const auto picture = decode(source);
    it->second = picture && is_light_blue(*picture);
    if (!picture) note_fault(source, path, picture.error().message);
  }
  return it->second;
}

std::vector<std::string> NamedPictures::report_faults() const {
  std::vector<std::string> lines;
  for (const auto& [key, fault] : faults_)
    lines.push_back("1 texture map " + in_quotes(fault.name) + " not carried: it " + fault.text);
  const auto converted = carried_.report();
  lines.insert(lines.end(), converted.begin(), converted.end());
  return lines;
}

std::vector<std::string> NamedPictures::report_decoded() const {
  const auto baked = std::count_if(decoded_.begin(), decoded_.end(),
                                   [](const auto& entry) { return entry.second.has_value(); });
  if (baked == 0) return {};
  return {counted(static_cast<std::uint64_t>(baked), "texture map") +
          " baked into vertex colours; no step is needed"};
}

LinearColour sample_upwards(const Picture& picture, double u, double v) {
  return sample(picture, u, 1 - v, Wrap::kRepeat, Wrap::kRepeat);
}

}  // namespace vitrine::inline codec
