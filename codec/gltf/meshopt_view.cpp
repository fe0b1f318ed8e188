// SPDX-License-Identifier: Apache-2.0
#include "codec/gltf/meshopt_view.h"

#include <meshoptimizer.h>

#include "codec/repair/raw_mesh.h"

namespace vitrine::inline codec {
namespace {

constexpr std::uint64_t kMostExpansion = 64;

struct ViewLayout {
  std::uint64_t count, stride;
  std::uint64_t bytes() const { return count * stride; }
};

Unexpected damaged() {
  return bad_input("is not valid meshopt-compressed data");
}

// Checks the preconditions of meshoptimizer's decoders, which otherwise abort. Also checks that the
// compressed data can hold the stated number of elements.
bool is_valid(const ViewLayout& layout, std::string_view mode, std::size_t compressed) {
  if (layout.count == 0 || layout.count > kMostExpansion * compressed) return false;
  const bool is_index = layout.stride == 2 || layout.stride == 4;
  if (mode == "ATTRIBUTES") {
    if (layout.stride == 0 || layout.stride > 256 || layout.stride % 4 != 0) return false;
  } else if (mode == "TRIANGLES") {
    if (!is_index || layout.count % 3 != 0) return false;
  } else if (!is_index) {
    return false;
  }
  return layout.bytes() <= kMostExpansion * compressed;
}

bool decode(std::vector<std::uint8_t>& out, const ViewLayout& layout, std::string_view mode,
            std::span<const std::uint8_t> in) {
  int fault = 0;
  if (mode == "ATTRIBUTES") {
    fault =
        meshopt_decodeVertexBuffer(out.data(), layout.count, layout.stride, in.data(), in.size());
  } else if (mode == "TRIANGLES") {
    fault =
        meshopt_decodeIndexBuffer(out.data(), layout.count, layout.stride, in.data(), in.size());
  } else {
    fault =
        meshopt_decodeIndexSequence(out.data(), layout.count, layout.stride, in.data(), in.size());
  }
  return fault == 0;
}

// Applies the filter of a view. Ignores the filters for normals and rotations, because the codec
// reads neither. Returns false if the filter is unknown or does not fit the stride.
bool unfilter(std::vector<std::uint8_t>& out, const ViewLayout& layout, std::string_view filter) {
  if (filter == "EXPONENTIAL" && layout.stride % 4 == 0) {
    meshopt_decodeFilterExp(out.data(), layout.count, layout.stride);
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
  const ViewLayout layout{whole(extension, "count", 0), whole(extension, "byteStride", 0)};
  if (!is_valid(layout, mode, compressed.size())) return damaged();
  std::vector<std::uint8_t> out(layout.bytes());
  if (!decode(out, layout, mode, compressed)) return damaged();
  if (!unfilter(out, layout, filter)) {
    return fail(ErrorCode::kUnsupported, "has the unknown meshopt filter " + in_quotes(filter));
  }
  return out;
}

}  // namespace vitrine::inline codec
