// SPDX-License-Identifier: Apache-2.0
#include "codec/picture/carried_pictures.h"

#include "codec/picture/decode_picture.h"
#include "codec/picture/write_picture.h"

namespace vitrine::inline codec {

Expected<std::uint32_t> CarriedPictures::add(std::string name, std::span<const std::uint8_t> bytes,
                                             std::uint64_t most_bytes) {
  const SpanKey key{bytes.data(), bytes.size()};
  if (const auto known = by_span_.find(key); known != by_span_.end()) return known->second;
  if (auto ok = check_picture_format(bytes); !ok) return tl::unexpected(ok.error());
  if (bytes.size() > most_bytes || bytes_ > most_bytes - bytes.size()) {
    return fail(ErrorCode::kLimit,
                "brings all pictures together over their size limit; make them smaller");
  }
  bytes_ += bytes.size();
  const auto index = static_cast<std::uint32_t>(pictures_.size());
  const auto [it, is_new] = by_contents_.try_emplace(sha256(bytes), index);
  if (is_new) {
    auto kept = as_carried_format(bytes);
    if (!kept) return by_contents_.erase(it), tl::unexpected(kept.error());
    pictures_.push_back({std::move(name), *std::move(kept)});
  }
  by_span_.emplace(key, it->second);
  return it->second;
}

std::vector<std::string> CarriedPictures::report() const {
  if (converted_ == 0) return {};
  return {std::to_string(converted_) + " texture map" + (converted_ == 1 ? "" : "s") +
          " kept as PNG: TIFF, BMP and TGA files are not kept themselves; archive them with "
          "the mesh"};
}

Expected<std::vector<std::uint8_t>> CarriedPictures::as_carried_format(
    std::span<const std::uint8_t> bytes) {
  if (is_carried_format(bytes)) return std::vector(bytes.begin(), bytes.end());
  const auto picture = decode_picture_within(pixels_left_, bytes);
  if (!picture) return tl::unexpected(picture.error());
  auto png = write_png(*picture);
  if (!png) return fail(ErrorCode::kUnsupported, "cannot be kept as PNG; convert it to PNG");
  png->shrink_to_fit();
  ++converted_;
  return png;
}

}  // namespace vitrine::inline codec
