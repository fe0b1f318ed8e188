// SPDX-License-Identifier: Apache-2.0
#include "codec/build/source_coordinates.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "codec/core/range_coder.h"

namespace vitrine::inline codec {
namespace {

constexpr int kWidthBits = 6;

bool are_same_bits(const TextureCoordinates& a, const TextureCoordinates& b) {
  using Bits = std::array<std::uint32_t, 2>;
  return std::bit_cast<Bits>(a) == std::bit_cast<Bits>(b);
}

// Maps the bits of a float to an integer that preserves the order of floats. The map is its own
// inverse.
std::uint32_t in_order(std::uint32_t bits) {
  return (bits & 0x8000'0000u) != 0 ? bits ^ 0x7FFF'FFFFu : bits;
}

// Codes a float, given a prediction. Maps the float and the prediction to integers by in_order()
// and codes the difference of the integers.
class FloatModel {
 public:
  template <class Coder>
  float code(Coder& coder, float expected, float truth) {
    const std::uint32_t centre = in_order(std::bit_cast<std::uint32_t>(expected));
    const std::uint32_t told = in_order(std::bit_cast<std::uint32_t>(truth)) - centre;
    const std::uint32_t zigzag = told << 1 ^ ((told >> 31) != 0 ? 0xFFFF'FFFFu : 0u);
    const std::uint32_t coded = code_number(coder, zigzag);
    const std::uint32_t difference = coded >> 1 ^ ((coded & 1u) != 0 ? 0xFFFF'FFFFu : 0u);
    return std::bit_cast<float>(in_order(centre + difference));
  }

 private:
  // Codes the number of significant bits, then the bits after the most significant one.
  template <class Coder>
  std::uint32_t code_number(Coder& coder, std::uint32_t number) {
    const auto told = static_cast<std::uint32_t>(std::bit_width(number));
    std::uint32_t node = 1;
    for (int place = kWidthBits - 1; place >= 0; --place) {
      const int bit = coder.bit(width_[node], static_cast<int>(told >> place & 1u));
      node = node << 1 | static_cast<std::uint32_t>(bit);
    }
    const std::uint32_t width = std::min(node - (1u << kWidthBits), 32u);
    if (width < 2) return width;
    const std::uint32_t first = 1u << (width - 1);
    return first | coder.raw(number & (first - 1), static_cast<int>(width - 1));
  }

  std::array<AdaptiveBit, 1u << kWidthBits> width_;
};

// Models for one set of texture coordinates.
struct SetModel {
  template <class Coder>
  TextureCoordinates code(Coder& coder, const TextureCoordinates& expected,
                          const TextureCoordinates& truth, bool is_tip) {
    auto& model = at[is_tip ? 1 : 0];
    const float u = model[0].code(coder, expected[0], truth[0]);
    return {u, model[1].code(coder, expected[1], truth[1])};
  }

  std::array<AdaptiveBit, 3> is_same;  // one bit model for each of the three candidates
  std::array<std::array<FloatModel, 2>, 2> at;
  TextureCoordinates last{};
};

float as_float(double x) {
  constexpr double kMost = std::numeric_limits<float>::max();
  return static_cast<float>(std::clamp(x, -kMost, kMost));
}

// Encodes or decodes the texture coordinates of all faces. Encoder and decoder run the same pass
// over the same mesh. An encoder reads the values from `texturing`; a decoder writes them to it.
template <class Coder>
class SourcePass {
 public:
  SourcePass(const Connectivity& mesh, std::uint32_t faces, Texturing& texturing, Coder& coder)
      : mesh_(mesh),
        corners_(3 * faces),
        texturing_(texturing),
        coder_(coder),
        is_queued_(faces, false),
        is_coded_(faces, false) {
    for (std::size_t set = 0; set < kCoordinateSets; ++set) {
      if (!texturing_.coordinates[set].empty())
        last_at_[set].assign(mesh.vertex_count(), kNoCorner);
    }
  }

  // Returns false if a decoded value is out of range.
  bool run() {
    for (Corner c = 0; c < corners_; c += 3) {
      if (!is_queued_[c / 3] && !code_from(c)) return false;
    }
    return true;
  }

 private:
  // Codes the face of corner c and then, in breadth-first order, all faces that are connected with
  // it across edges.
  bool code_from(Corner c) {
    queue_ = {c};
    is_queued_[c / 3] = true;
    for (std::size_t i = 0; i < queue_.size(); ++i) {
      const Corner tip = queue_[i];
      if (!code_face(tip)) return false;
      for (const Corner d : {tip, next(tip), prev(tip)}) {
        const Corner across = mesh_.opposite(d);
        if (across >= corners_ || is_queued_[across / 3]) continue;
        is_queued_[across / 3] = true;
        queue_.push_back(across);
      }
    }
    return true;
  }

  bool code_face(Corner tip) {
    if (!code_material(tip / 3)) return false;
    for (std::size_t set = 0; set < kCoordinateSets; ++set) {
      if (texturing_.coordinates[set].empty()) continue;
      for (const Corner c : {next(tip), prev(tip), tip}) {
        if (!code_corner(set, c, tip)) return false;
      }
    }
    is_coded_[tip / 3] = true;
    return true;
  }

  bool code_material(std::uint32_t face) {
    std::uint16_t& material = texturing_.face_materials[face];
    const bool is_same = coder_.bit(is_same_material_, material == material_ ? 1 : 0) != 0;
    if (!is_same) material_ = static_cast<std::uint16_t>(coder_.raw(material, 16));
    material = material_;
    return material < texturing_.materials.size();
  }

  bool code_corner(std::size_t set, Corner c, Corner tip) {
    SetModel& model = models_[set];
    TextureCoordinates& value = at(set, c);
    if (const auto same = code_candidate(set, c)) {
      value = *same;
    } else {
      const bool is_tip = c == tip && is_coded(mesh_.opposite(tip));
      const TextureCoordinates expected = is_tip ? across(set, tip) : model.last;
      value = model.code(coder_, expected, value, is_tip);
    }
    model.last = value;
    last_at_[set][mesh_.vertex(c)] = c;
    return std::isfinite(value[0]) && std::isfinite(value[1]);
  }

  // Codes which of three candidates has the same coordinates as the corner c, if any does. The
  // candidates are already coded corners at the same vertex: two in the faces across the two edges
  // at c, and the corner coded last at this vertex.
  std::optional<TextureCoordinates> code_candidate(std::size_t set, Corner c) {
    const std::array<Corner, 3> candidates = {at_vertex(next(c), true), at_vertex(prev(c), false),
                                              last_at_[set][mesh_.vertex(c)]};
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      if (candidates[i] == kNoCorner) continue;
      const TextureCoordinates there = at(set, candidates[i]);
      const auto is_tried = [&](Corner d) {
        return d != kNoCorner && are_same_bits(at(set, d), there);
      };
      if (std::any_of(candidates.begin(), candidates.begin() + static_cast<std::ptrdiff_t>(i),
                      is_tried))
        continue;
      const bool told = are_same_bits(at(set, c), there);
      if (coder_.bit(models_[set].is_same[i], told ? 1 : 0) != 0) return there;
    }
    return std::nullopt;
  }

  // Returns the corner that a neighbouring face has at the vertex of a corner c. The neighbour lies
  // across the edge opposite to `other`, which is next(c) if `is_next`, else prev(c). Returns
  // kNoCorner if the neighbour is not coded yet.
  Corner at_vertex(Corner other, bool is_next) const {
    const Corner across = mesh_.opposite(other);
    if (!is_coded(across)) return kNoCorner;
    return is_next ? next(across) : prev(across);
  }

  // Predicts the coordinates of corner `tip` as the fourth corner of a parallelogram. The other
  // three are the two other corners of its face, and the corner opposite to `tip` in the face
  // across their edge.
  TextureCoordinates across(std::size_t set, Corner tip) {
    const TextureCoordinates &a = at(set, next(tip)), &b = at(set, prev(tip)),
                             &opposite = at(set, mesh_.opposite(tip));
    const auto sum = [&](std::size_t i) {
      return as_float(static_cast<double>(a[i]) + static_cast<double>(b[i]) -
                      static_cast<double>(opposite[i]));
    };
    return {sum(0), sum(1)};
  }

  bool is_coded(Corner c) const { return c < corners_ && is_coded_[c / 3]; }
  TextureCoordinates& at(std::size_t set, Corner c) {
    return texturing_.coordinates[set][c / 3][c % 3];
  }

  const Connectivity& mesh_;
  // Number of corners of real faces. Corners from this number on belong to the faces that close
  // boundary loops.
  const Corner corners_;
  Texturing& texturing_;
  Coder& coder_;
  std::vector<bool> is_queued_, is_coded_;  // one flag per face
  std::vector<Corner> queue_;               // faces still to be coded by code_from()
  // Per set of coordinates and vertex: the corner coded last. The vector of a set that is not coded
  // is empty.
  std::array<std::vector<Corner>, kCoordinateSets> last_at_;
  std::array<SetModel, kCoordinateSets> models_;
  AdaptiveBit is_same_material_;
  std::uint16_t material_ = 0;  // material of the face coded last
};

}  // namespace

std::vector<std::uint8_t> encode_source_coordinates(const Connectivity& mesh, std::uint32_t faces,
                                                    Texturing texturing) {
  RangeEncoder coder;
  SourcePass<RangeEncoder>(mesh, faces, texturing, coder).run();
  return coder.finish();
}

Expected<void> decode_source_coordinates(std::span<const std::uint8_t> bytes,
                                         const Connectivity& mesh, std::uint32_t faces,
                                         const std::array<bool, kCoordinateSets>& has_set,
                                         Texturing& texturing) {
  texturing.face_materials.assign(faces, 0);
  for (std::size_t set = 0; set < kCoordinateSets; ++set)
    texturing.coordinates[set].assign(has_set[set] ? faces : 0, {});
  RangeDecoder coder(bytes);
  if (SourcePass<RangeDecoder>(mesh, faces, texturing, coder).run()) return {};
  return fail(ErrorCode::kBadInput,
              "a face of the originals has an impossible material or coordinate; fetch the file "
              "again");
}

}  // namespace vitrine::inline codec
