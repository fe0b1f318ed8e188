// SPDX-License-Identifier: Apache-2.0
#include "codec/import/gltf_buffer.h"

#include <algorithm>
#include <string>

#include "codec/import/byte_cursor.h"
#include "codec/import/raw_mesh.h"

namespace vitrine {
namespace {

const Json kNull;

Unexpected bad(std::uint64_t index, std::string what) {
  return bad_input("GLB accessor " + std::to_string(index) + ' ' + std::move(what) +
                   "; the file is damaged, export it again");
}

}  // namespace

const Json& member(const Json& object, std::string_view key) {
  if (!object.is_object()) return kNull;
  const auto it = object.find(key);
  return it == object.end() ? kNull : *it;
}

const Json& element(const Json& document, std::string_view key, std::uint64_t index) {
  const Json& array = member(document, key);
  return array.is_array() && index < array.size() ? array[index] : kNull;
}

std::uint64_t whole(const Json& object, std::string_view key, std::uint64_t otherwise) {
  const Json& value = member(object, key);
  return value.is_number_unsigned() ? value.get<std::uint64_t>() : otherwise;
}

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

std::uint32_t Accessor::width_of(std::string_view type) {
  if (type == "SCALAR") return 1;
  return type == "VEC3" ? 3 : type == "VEC4" ? 4 : 0;
}

Expected<Accessor> Accessor::open(const Json& document, std::span<const std::uint8_t> buffer,
                                  std::uint64_t index) {
  const Json& self = element(document, "accessors", index);
  if (!member(self, "sparse").is_null()) {
    return fail(ErrorCode::kUnsupported, "GLB accessor " + std::to_string(index) +
                                             " is sparse, which is not read; export it dense");
  }
  const Json& view = element(document, "bufferViews", whole(self, "bufferView", kAbsent));
  if (!view.is_object()) return bad(index, "has no buffer view");
  if (whole(view, "buffer", kAbsent) != 0) return bad(index, "is not in the file's binary chunk");
  Accessor out;
  out.type_ = static_cast<Type>(std::min<std::uint64_t>(whole(self, "componentType", 0), 0xFFFF));
  const Json& type = member(self, "type");
  out.width_ = width_of(type.is_string() ? type.get_ref<const std::string&>() : std::string());
  const std::uint64_t size = std::uint64_t{byte_size(out.type_)} * out.width_;
  if (size == 0) return bad(index, "has an unknown type");
  const Json& normalised = member(self, "normalized");
  out.normalised_ = normalised.is_boolean() && normalised.get<bool>();
  out.count_ = whole(self, "count", 0);
  out.stride_ = whole(view, "byteStride", size);
  const std::uint64_t view_begin = whole(view, "byteOffset", 0);
  const std::uint64_t view_size = whole(view, "byteLength", 0);
  if (view_begin > buffer.size() || view_size > buffer.size() - view_begin) {
    return bad(index, "lies beyond the end of the binary chunk");
  }
  const std::uint64_t begin = whole(self, "byteOffset", 0);
  if (out.count_ == 0 || out.stride_ < size || out.stride_ > 255 || begin > view_size ||
      view_size - begin < size || (view_size - begin - size) / out.stride_ < out.count_ - 1) {
    return bad(index, "does not fit its buffer view");
  }
  out.bytes_ = buffer.subspan(view_begin + begin, view_size - begin);
  return out;
}

double Accessor::real(std::uint64_t i, std::uint32_t k) const {
  const std::uint8_t* at = bytes_.data() + i * stride_ + std::uint64_t{k} * byte_size(type_);
  const auto scaled = [&](double value, double most) {
    return normalised_ ? std::max(value / most, -1.0) : value;
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

}  // namespace vitrine
