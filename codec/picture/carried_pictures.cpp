// SPDX-License-Identifier: Apache-2.0
#include "codec/picture/carried_pictures.h"

#include "codec/picture/decode_picture.h"

namespace vitrine::inline codec {

Expected<std::uint32_t> CarriedPictures::add(std::string name, std::span<const std::uint8_t> bytes,
                                             std::uint64_t most_bytes) {
  const Place place{bytes.data(), bytes.size()};
  if (const auto known = by_place_.find(place); known != by_place_.end()) return known->second;
  if (auto ok = check_picture_format(bytes); !ok) return tl::unexpected(ok.error());
  if (bytes.size() > most_bytes || bytes_ > most_bytes - bytes.size()) {
    return fail(ErrorCode::kLimit,
                "brings all pictures together over their size limit; make them smaller");
  }
  bytes_ += bytes.size();
  const auto index = static_cast<std::uint32_t>(pictures_.size());
  const auto [it, is_new] = by_contents_.try_emplace(sha256(bytes), index);
  if (is_new) pictures_.push_back({std::move(name), {bytes.begin(), bytes.end()}});
  by_place_.emplace(place, it->second);
  return it->second;
}

}  // namespace vitrine::inline codec
