// SPDX-License-Identifier: Apache-2.0
#include "codec/import/meshopt_view.h"

#include <meshoptimizer.h>

#include "codec/import/raw_mesh.h"

namespace vitrine {
namespace {

constexpr std::uint64_t kMostExpansion = 64;

struct Shape {
  std::uint64_t count, stride;
  std::uint64_t bytes() const { return count * stride; }
};

Unexpected damaged() {
  return bad_input("is not valid meshopt-compressed data");
}

// What each decoder asks for (it asserts instead of failing), and that the data can hold as much.
bool is_valid(const Shape& shape, std::string_view mode, std::size_t compressed) {
  if (shape.count == 0 || shape.count > kMostExpansion * compressed) return false;
  const bool is_index = shape.stride == 2 || shape.stride == 4;
  if (mode == "ATTRIBUTES") {
    if (shape.stride == 0 || shape.stride > 256 || shape.stride % 4 != 0) return false;
  } else if (mode == "TRIANGLES") {
    if (!is_index || shape.count % 3 != 0) return false;
  } else if (!is_index) {
    return false;
  }
  return shape.bytes() <= kMostExpansion * compressed;
}

bool decode(std::vector<std::uint8_t>& out, const Shape& shape, std::string_view mode,
            std::span<const std::uint8_t> in) {
  int fault = 0;
  if (mode == "ATTRIBUTES") {
    fault = meshopt_decodeVertexBuffer(out.data(), shape.count, shape.stride, in.data(), in.size());
  } else if (mode == "TRIANGLES") {
    fault = meshopt_decodeIndexBuffer(out.data(), shape.count, shape.stride, in.data(), in.size());
  } else {
    fault =
        meshopt_decodeIndexSequence(out.data(), shape.count, shape.stride, in.data(), in.size());
  }
  return fault == 0;
}

// The filters of normals and rotations are not needed: neither is read.
bool unfilter(std::vector<std::uint8_t>& out, const Shape& shape, std::string_view filter) {
  if (filter == "EXPONENTIAL" && shape.stride % 4 == 0) {
    meshopt_decodeFilterExp(out.data(), shape.count, shape.stride);
    return true;
  }
  return filter == "NONE" || filter == "OCTAHEDRAL" || filter == "QUATERNION";
}

}  // namespace

Expected<std::vector<std::uint8_t>> decode_meshopt(const Json& extension,
                                                   std::span<const std::uint8_t> compressed) {
  const std::string mode = text(extension, "mode", ""), filter = text(extension, "filter", "NONE");
  if (mode != "ATTRIBUTES" && mode != "TRIANGLES" && mode != "INDICES") {
    return fail(ErrorCode::kUnsupported, "has the unknown meshopt mode " + in_quotes(mode));
  }
  const Shape shape{whole(extension, "count", 0), whole(extension, "byteStride", 0)};
  if (!is_valid(shape, mode, compressed.size())) return damaged();
  std::vector<std::uint8_t> out(shape.bytes());
  if (!decode(out, shape, mode, compressed)) return damaged();
  if (!unfilter(out, shape, filter)) {
    return fail(ErrorCode::kUnsupported, "has the unknown meshopt filter " + in_quotes(filter));
  }
  return out;
}

}  // namespace vitrine
