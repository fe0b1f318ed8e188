// SPDX-License-Identifier: Apache-2.0
#include "codec/import/named_pictures.h"

#include <algorithm>
#include <cmath>

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

Expected<std::span<const std::uint8_t>> NamedPictures::bytes(std::string_view name) const {
  const auto found = find_companion(companions_, name);
  if (!found) return bad_input("is not beside the mesh file");
  return *found;
}

void NamedPictures::note_fault(std::string_view name, const std::string& fault) {
  faults_.try_emplace(companion_key(name), Fault{std::string(name), fault});
}

const Picture* NamedPictures::find(std::string_view name) {
  const auto [it, is_new] = decoded_.try_emplace(companion_key(name));
  if (is_new) {
    const auto encoded = bytes(name);
    auto picture = encoded ? decode_picture(*encoded, pixels_left_)
                           : Expected<Picture>(tl::unexpected(encoded.error()));
    if (picture) {
      pixels_left_ -= std::uint64_t{picture->width} * picture->height;
      it->second = *std::move(picture);
    } else {
      note_fault(name, picture.error().message);
    }
  }
  return it->second ? &*it->second : nullptr;
}

std::optional<std::uint32_t> NamedPictures::carry(std::string_view name) {
  if (faults_.contains(companion_key(name))) return std::nullopt;
  const auto encoded = bytes(name);
  const auto index = encoded ? carried_.add(std::string(name), *encoded, limits_.picture_bytes)
                             : Expected<std::uint32_t>(tl::unexpected(encoded.error()));
  if (index) return *index;
  note_fault(name, index.error().message);
  return std::nullopt;
}

bool NamedPictures::shows_normals(std::string_view name) {
  const auto [it, is_new] = shows_normals_.try_emplace(companion_key(name), false);
  if (is_new) {
    const auto encoded = bytes(name);
    const auto picture = encoded ? decode_picture(*encoded, pixels_left_)
                                 : Expected<Picture>(tl::unexpected(encoded.error()));
    it->second = picture && is_light_blue(*picture);
    if (!picture) note_fault(name, picture.error().message);
  }
  return it->second;
}

std::vector<std::string> NamedPictures::report_faults() const {
  std::vector<std::string> lines;
  for (const auto& [key, fault] : faults_)
    lines.push_back("texture map " + in_quotes(fault.name) + " not carried: it " + fault.text);
  return lines;
}

std::vector<std::string> NamedPictures::report_decoded() const {
  const auto baked = std::count_if(decoded_.begin(), decoded_.end(),
                                   [](const auto& entry) { return entry.second.has_value(); });
  if (baked == 0) return {};
  return {counted(static_cast<std::uint64_t>(baked), "texture map") + " baked into vertex colours"};
}

LinearColour sample_upwards(const Picture& picture, double u, double v) {
  return sample(picture, u, 1 - v, Wrap::kRepeat, Wrap::kRepeat);
}

}  // namespace vitrine::inline codec
