// SPDX-License-Identifier: Apache-2.0
#include "codec/gltf/gltf_accessor.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>

#include "codec/core/byte_cursor.h"
#include "codec/repair/raw_mesh.h"

namespace vitrine::inline codec {
namespace {

Unexpected bad_accessor(std::uint64_t index, std::string what) {
  return bad_input("glTF accessor " + std::to_string(index) + ' ' + std::move(what) +
                   "; the file is damaged, export it again");
}

std::uint32_t width_of(std::string_view type) {
  if (type == "SCALAR") return 1;
  if (type == "VEC2") return 2;
  if (type == "MAT4") return 16;
  return type == "VEC3" ? 3 : type == "VEC4" ? 4 : 0;
}

std::uint32_t integer_at(const std::uint8_t* at, Accessor::Type type) {
  switch (type) {
    case Accessor::kUbyte:
      return load<std::uint8_t>(at);
    case Accessor::kUshort:
      return load<std::uint16_t>(at);
    case Accessor::kUint:
      return load<std::uint32_t>(at);
    default:
      return 0xFFFF'FFFFu;
  }
}

Accessor::Type type_of(const Json& object) {
  return static_cast<Accessor::Type>(
      std::min<std::uint64_t>(whole(object, "componentType", 0), 0xFFFF));
}

// Returns `count` elements of `size` bytes each in the buffer view that `place` names. Returns
// nullopt if they extend beyond the view.
Expected<std::optional<std::span<const std::uint8_t>>> dense_part(const Json& place,
                                                                  GltfBuffer& buffer,
                                                                  std::uint64_t count,
                                                                  std::uint64_t size) {
  const auto view = buffer.view(whole(place, "bufferView", kAbsent));
  if (!view) return tl::unexpected(view.error());
  const std::uint64_t begin = whole(place, "byteOffset", 0), end = view->bytes.size();
  if (begin > end || (end - begin) / size < count) return std::nullopt;
  return view->bytes.subspan(begin, count * size);
}

}  // namespace

std::uint32_t Accessor::byte_size(Type type) {
  switch (type) {
    case kByte:
    case kUbyte:
      return 1;
    case kShort:
    case kUshort:
      return 2;
    case kUint:
    case kFloat:
      return 4;
  }
  return 0;
}

Expected<Accessor> Accessor::described(const Json& document, std::uint64_t index) {
  const Json& self = element(document, "accessors", index);
  Accessor out;
  out.type_ = type_of(self);
  out.width_ = width_of(text(self, "type", ""));
  if (byte_size(out.type_) * out.width_ == 0) return bad_accessor(index, "has an unknown type");
  const Json& normalised = member(self, "normalized");
  out.is_normalised_ = normalised.is_boolean() && normalised.get<bool>();
  out.count_ = whole(self, "count", 0);
  return out;
}

// Sets the accessor to read its values from `view`, starting at byte `begin`. Fails if the values
// extend beyond the view.
Expected<void> Accessor::place(const BufferView& view, std::uint64_t begin, std::uint64_t index,
                               std::uint64_t needed) {
  const std::uint64_t size = value_bytes(), end = view.bytes.size();
  const auto fitting = [&](std::uint64_t stride) {
    return begin > end || end - begin < size ? 0 : (end - begin - size) / stride + 1;
  };
  stride_ = view.stride == 0 ? size : view.stride;
  if (stride_ < size || (fitting(stride_) < count_ && fitting(size) >= count_)) {
    is_corrected_ = stride_ != size;
    stride_ = size;
  }
  const std::uint64_t most = fitting(stride_);
  if ((count_ < needed || count_ > most) && needed <= most && needed > 0) {
    count_ = needed;
    is_corrected_ = true;
  }
  if (count_ == 0 || count_ > most) return bad_accessor(index, "does not fit its buffer view");
  bytes_ = view.bytes.subspan(begin);
  return {};
}

Expected<void> Accessor::open_sparse(const Json& sparse, GltfBuffer& buffer, std::uint64_t index) {
  const Json& places = member(sparse, "indices");
  const std::uint64_t count = whole(sparse, "count", 0);
  const Type type = type_of(places);
  if (type != kUbyte && type != kUshort && type != kUint)
    return bad_accessor(index, "has sparse indices of an unknown type");
  const auto indices = dense_part(places, buffer, count, byte_size(type));
  if (!indices) return tl::unexpected(indices.error());
  const auto values = dense_part(member(sparse, "values"), buffer, count, value_bytes());
  if (!values) return tl::unexpected(values.error());
  if (!*indices || !*values)
    return bad_accessor(index, "has sparse values that do not fit their buffer view");
  sparse_ = {count, type, **indices, **values};
  for (std::uint64_t i = 0; i < count; ++i) {
    if (sparse_.index(i) >= count_ || (i > 0 && sparse_.index(i) <= sparse_.index(i - 1)))
      return bad_accessor(index, "has sparse indices that are too large or do not ascend");
  }
  return {};
}

Expected<Accessor> Accessor::open(const Json& document, GltfBuffer& buffer, std::uint64_t index,
                                  std::uint64_t needed) {
  auto out = described(document, index);
  if (!out) return out;
  const Json& self = element(document, "accessors", index);
  const Json& sparse = member(self, "sparse");
  const std::uint64_t view_index = whole(self, "bufferView", kAbsent);
  if (view_index == kAbsent) {
    if (!sparse.is_object()) return bad_accessor(index, "has no buffer view");
    // Without a buffer view, all values are zero except the sparse ones, and no view limits their
    // number. A real mesh has other data for each vertex, so the file has at least as many bytes as
    // vertices.
    if (out->count_ > buffer.bytes()) return bad_accessor(index, "has more values than the file");
  } else {
    const auto view = buffer.view(view_index);
    if (!view) return tl::unexpected(view.error());
    if (auto ok = out->place(*view, whole(self, "byteOffset", 0), index, needed); !ok)
      return tl::unexpected(ok.error());
  }
  if (!sparse.is_object()) return out;
  if (auto ok = out->open_sparse(sparse, buffer, index); !ok) return tl::unexpected(ok.error());
  return out;
}

Expected<Accessor> Accessor::over(const Json& document, std::span<const std::uint8_t> values,
                                  std::uint64_t index) {
  auto out = described(document, index);
  if (!out) return out;
  const std::uint64_t count = values.size() / out->value_bytes();
  out->is_corrected_ = out->count_ != count;
  out->count_ = count;
  if (auto ok = out->place({values, 0}, 0, index, 0); !ok) return tl::unexpected(ok.error());
  return out;
}

bool Accessor::normalise() {
  if (is_normalised_ || byte_size(type_) > 2) return false;
  return is_normalised_ = true;
}

std::uint64_t Accessor::Sparse::index(std::uint64_t i) const {
  return integer_at(indices.data() + i * byte_size(type), type);
}

std::uint64_t Accessor::Sparse::find(std::uint64_t i) const {
  std::uint64_t low = 0, high = count;
  while (low < high) {
    const std::uint64_t middle = low + (high - low) / 2;
    if (index(middle) < i) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

const std::uint8_t* Accessor::at(std::uint64_t i) const {
  constexpr std::uint64_t kMostValueBytes = 64;  // 16 components of 4 bytes
  static constexpr std::array<std::uint8_t, kMostValueBytes> kZero{};
  if (sparse_.count > 0) {
    const std::uint64_t found = sparse_.find(i);
    if (found < sparse_.count && sparse_.index(found) == i)
      return sparse_.values.data() + found * value_bytes();
  }
  return bytes_.empty() ? kZero.data() : bytes_.data() + i * stride_;
}

double Accessor::real(std::uint64_t i, std::uint32_t k) const {
  const std::uint8_t* from = at(i) + std::uint64_t{k} * byte_size(type_);
  const auto scaled = [&](double value, double most) {
    return is_normalised_ ? std::max(value / most, -1.0) : value;
  };
  switch (type_) {
    case kByte:
      return scaled(load<std::int8_t>(from), 127);
    case kUbyte:
      return scaled(load<std::uint8_t>(from), 255);
    case kShort:
      return scaled(load<std::int16_t>(from), 32767);
    case kUshort:
      return scaled(load<std::uint16_t>(from), 65535);
    case kUint:
      return load<std::uint32_t>(from);
    default:
      return load<float>(from);
  }
}

std::uint32_t Accessor::index(std::uint64_t i) const {
  return integer_at(at(i), type_);
}

}  // namespace vitrine::inline codec
