// SPDX-License-Identifier: Apache-2.0
#include "codec/base/base_decoder.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "codec/base/base_values.h"
#include "codec/base/coded_order.h"
#include "codec/base/draco_layout.h"
#include "codec/base/edgebreaker.h"

namespace vitrine::inline codec {
namespace {

// The Draco header: the magic "DRACO", bitstream version 2.2, a mesh (1), coded by the edgebreaker
// method (1), and no metadata flags.
constexpr std::array<std::uint8_t, 11> kHeader = {'D', 'R', 'A', 'C', 'O', 2, 2, 1, 1, 0, 0};
constexpr std::uint8_t kNoSeams = 0xFF, kPerVertex = 0, kOfIntegers = 1;

enum OrderKind : std::uint8_t { kDepthFirst = 0, kPredictionDegree = 1 };
using OrderKinds = std::array<OrderKind, 1 + kSemantics>;

// Reads as many bytes as `expected` has, and returns whether they equal `expected`.
template <std::size_t count>
bool follow(ByteReader& in, const std::array<std::uint8_t, count>& expected) {
  const auto bytes = in.bytes(count);
  return std::equal(bytes.begin(), bytes.end(), expected.begin(), expected.end());
}

Unexpected other_attributes() {
  return fail(ErrorCode::kUnsupported,
              "the base mesh has other attributes than its model; build the model again");
}

// Reads the coding parameters of each attribute; the first attribute is the position. Returns, for
// each attribute, the order in which the values of the vertices are coded.
Expected<OrderKinds> read_orders(ByteReader& in, const PerSemantic<Semantic>& semantics) {
  const std::size_t count = 1 + semantics.size();
  if (in.u8() != count) return other_attributes();
  OrderKinds orders{};
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t seams = i == 0 ? kNoSeams : static_cast<std::uint8_t>(i - 1);
    if (in.u8() != seams || in.u8() != kPerVertex) return other_attributes();
    orders[i] = OrderKind{in.u8()};
    if (orders[i] > kPredictionDegree) return other_attributes();
  }
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t type = i == 0 ? kDracoPosition : draco_type(semantics[i - 1]);
    const std::array<std::uint8_t, 5> row = {1, type, kDracoInt32, 3, 0};
    if (!follow(in, row)) return other_attributes();
    in.varint32();  // skips the attribute's unique ID
    if (in.u8() != kOfIntegers) return other_attributes();
  }
  return orders;
}

Expected<std::vector<Vec3i>> read_attribute(ByteReader& in, const CornerTable& table,
                                            OrderKind kind) {
  const CodedOrder order =
      kind == kDepthFirst ? depth_first_order(table) : prediction_degree_order(table);
  if (order.corner.size() != table.vertex_count())
    return damaged_base("some vertices have no faces");
  return read_values(in, table, order);
}

std::vector<Triangle> faces_of(const CornerTable& table) {
  std::vector<Triangle> out;
  out.reserve(table.face_count());
  for (Corner c = 0; c < table.vertex.size(); c += 3)
    out.push_back({table.vertex[c], table.vertex[c + 1], table.vertex[c + 2]});
  return out;
}

}  // namespace

Expected<BaseMesh> decode_base(std::span<const std::uint8_t> bytes, const Manifest& manifest) {
  ByteReader in(bytes);
  if (!follow(in, kHeader)) return damaged_base("it is not a Draco edgebreaker mesh");
  const PerSemantic<Semantic>& semantics = manifest.attributes;
  const LevelInfo& level = manifest.levels[0];
  const auto table = read_connectivity(
      in, {level.vertices, level.faces, static_cast<std::uint32_t>(semantics.size())});
  if (!table) return tl::unexpected(table.error());
  const auto orders = read_orders(in, semantics);
  if (!orders) return tl::unexpected(orders.error());

  BaseMesh out;
  out.faces = faces_of(*table);
  for (std::size_t i = 0; i <= semantics.size(); ++i) {
    auto values = read_attribute(in, *table, (*orders)[i]);
    if (!values) return tl::unexpected(values.error());
    if (i == 0) {
      out.positions = std::move(*values);
    } else {
      out.attributes.push_back({semantics[i - 1], std::move(*values)});
    }
  }
  return out;
}

}  // namespace vitrine::inline codec
