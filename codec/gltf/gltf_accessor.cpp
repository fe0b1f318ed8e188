// SPDX-License-Identifier: Apache-2.0
#include "codec/gltf/gltf_accessor.h"

#include <algorithm>
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
  return type == "VEC3" ? 3 : type == "VEC4" ? 4 : 0;
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
  if (!member(self, "sparse").is_null()) {
    return fail(ErrorCode::kUnsupported, "glTF accessor " + std::to_string(index) +
                                             " is sparse, which is not read; export it dense");
  }
  Accessor out;
  out.type_ = static_cast<Type>(std::min<std::uint64_t>(whole(self, "componentType", 0), 0xFFFF));
  out.width_ = width_of(text(self, "type", ""));
  if (byte_size(out.type_) * out.width_ == 0) return bad_accessor(index, "has an unknown type");
  const Json& normalised = member(self, "normalized");
  out.is_normalised_ = normalised.is_boolean() && normalised.get<bool>();
  out.count_ = whole(self, "count", 0);
  return out;
}

// Makes the accessor read its values from `view`, starting at byte `begin`. Fails if they do not
// fit into the view.
Expected<void> Accessor::place(const BufferView& view, std::uint64_t begin, std::uint64_t index) {
  const std::uint64_t size = std::uint64_t{byte_size(type_)} * width_, end = view.bytes.size();
  stride_ = view.stride == 0 ? size : view.stride;
  if (count_ == 0 || stride_ < size || stride_ > 256 || begin > end || end - begin < size ||
      (end - begin - size) / stride_ < count_ - 1) {
    return bad_accessor(index, "does not fit its buffer view");
  }
  bytes_ = view.bytes.subspan(begin);
  return {};
}

Expected<Accessor> Accessor::open(const Json& document, GltfBuffer& buffer, std::uint64_t index) {
  auto out = described(document, index);
  if (!out) return out;
  const Json& self = element(document, "accessors", index);
  const std::uint64_t view_index = whole(self, "bufferView", kAbsent);
  if (view_index == kAbsent) return bad_accessor(index, "has no buffer view");
  const auto view = buffer.view(view_index);
  if (!view) return tl::unexpected(view.error());
  if (auto ok = out->place(*view, whole(self, "byteOffset", 0), index); !ok) {
    return tl::unexpected(ok.error());
  }
  return out;
}

Expected<Accessor> Accessor::over(const Json& document, std::span<const std::uint8_t> values,
                                  std::uint64_t index) {
  auto out = described(document, index);
  if (!out) return out;
  out->count_ = values.size() / (std::uint64_t{byte_size(out->type_)} * out->width_);
  if (auto ok = out->place({values, 0}, 0, index); !ok) return tl::unexpected(ok.error());
  return out;
}

double Accessor::real(std::uint64_t i, std::uint32_t k) const {
  const std::uint8_t* at = bytes_.data() + i * stride_ + std::uint64_t{k} * byte_size(type_);
  const auto scaled = [&](double value, double most) {
    return is_normalised_ ? std::max(value / most, -1.0) : value;
  };
  switch (type_) {
    case kByte:
      return scaled(load<std::int8_t>(at), 127);
    case kUbyte:
      return scaled(load<std::uint8_t>(at), 255);
    case kShort:
      return scaled(load<std::int16_t>(at), 32767);
    case kUshort:
      return scaled(load<std::uint16_t>(at), 65535);
    case kUint:
      return load<std::uint32_t>(at);
    default:
      return load<float>(at);
  }
}

std::uint32_t Accessor::index(std::uint64_t i) const {
  const std::uint8_t* at = bytes_.data() + i * stride_;
  switch (type_) {
    case kUbyte:
      return load<std::uint8_t>(at);
    case kUshort:
      return load<std::uint16_t>(at);
    case kUint:
      return load<std::uint32_t>(at);
    default:
      return 0xFFFF'FFFFu;
  }
}

}  // namespace vitrine::inline codec
