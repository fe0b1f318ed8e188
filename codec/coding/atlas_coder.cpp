// SPDX-License-Identifier: Apache-2.0
#include "codec/coding/atlas_coder.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "codec/coding/component_model.h"
#include "codec/coding/wedges.h"
#include "codec/core/exact_math.h"
#include "codec/core/range_coder.h"
#include "codec/format/manifest.h"
#include "codec/mesh/connectivity.h"

namespace vitrine::inline codec {
namespace {

constexpr std::uint32_t kNotNumbered = 0xFFFF'FFFFu;
constexpr int kShiftBits = 5;
constexpr std::uint32_t kMostShift = 20;

// Codes pairs of texture coordinates.
class PairModel {
 public:
  template <class Coder>
  Vec2i code(Coder& coder, const Vec2& expected, const Vec2i& truth) {
    Vec2i out;
    out.x = x_.code(coder, expected.x, truth.x);
    out.y = y_.code(coder, expected.y, truth.y);
    return out;
  }

 private:
  NumberModel x_, y_;
};

// Returns the position of a triangle's third corner in the picture if the triangle has the same
// shape there as in space. a and b are the first and second corner in the picture. `to_b` and
// `to_c` are the vectors in space from the first corner to the second and third.
Vec2 third_corner(const Vec2& a, const Vec2& b, const Vec3& to_b, const Vec3& to_c) {
  const double squared = dot(to_b, to_b);
  if (!(squared > 0)) return a;
  const double along = dot(to_b, to_c) / squared;
  const double beside = std::sqrt(std::max(dot(to_c, to_c) / squared - along * along, 0.0));
  const Vec2 side = b - a;
  return a + side * along + Vec2{-side.y, side.x} * beside;
}

// Returns how many low bits are 0 in all coordinates.
std::uint32_t common_shift(const BaseAtlas& atlas) {
  std::uint32_t bits = 1u << kMostShift;
  for (const Vec2i& at : atlas.coordinates)
    bits |= static_cast<std::uint32_t>(at.x | at.y);
  return static_cast<std::uint32_t>(std::countr_zero(bits));
}

// Encodes or decodes an atlas. Encoder and decoder run the same pass over the same faces. `truth`
// is the atlas to encode; a decoder passes an empty one.
template <class Coder>
class AtlasPass {
 public:
  AtlasPass(const Connectivity& mesh, const BaseMesh& base, const BaseAtlas& truth, Coder& coder)
      : mesh_(mesh),
        positions_(base.positions),
        corners_(static_cast<Corner>(3 * base.faces.size())),
        truth_(truth),
        coder_(coder),
        is_seam_(corners_, true),
        wedge_(corners_, kNotNumbered) {}

  Expected<BaseAtlas> run() {
    shift_ = coder_.raw(Coder::kEncodes ? common_shift(truth_) : 0, kShiftBits);
    if (shift_ > kMostShift) return outside();
    for (Corner c = 0; c < corners_; ++c)
      code_seam(c);
    number_wedges();
    for (Corner c = 0; c < corners_; c += 3) {
      if (!code_from(c)) return outside();
    }
    return finished();
  }

 private:
  static Unexpected outside() {
    return fail(ErrorCode::kBadInput, "a texture coordinate is outside the picture");
  }

  std::uint32_t told_wedge(Corner c) const { return truth_.wedges[c / 3][c % 3]; }
  Vec2i told_at(Corner c) const {
    const Vec2i& at = truth_.coordinates[told_wedge(c)];
    return {at.x >> shift_, at.y >> shift_};
  }

  // Codes whether the edge opposite to c is a seam. Skips boundary edges, and inner edges that were
  // coded from their other side.
  void code_seam(Corner c) {
    const Corner across = mesh_.opposite(c);
    if (across >= corners_ || across < c) return;
    const auto context = static_cast<std::size_t>(seams_of_face(c));
    const bool told = Coder::kEncodes && (told_wedge(next(c)) != told_wedge(prev(across)) ||
                                          told_wedge(prev(c)) != told_wedge(next(across)));
    is_seam_[c] = is_seam_[across] = coder_.bit(seam_[context], told ? 1 : 0) != 0;
  }

  // Returns how many of the face's other two edges are already known to be seams when the edge
  // opposite to c is coded.
  int seams_of_face(Corner c) const {
    int seams = 0;
    for (const Corner other : {next(c), prev(c)}) {
      const Corner across = mesh_.opposite(other);
      const bool is_coded = across < corners_ && std::min(other, across) < c;
      seams += is_coded && is_seam_[other] ? 1 : 0;
    }
    return seams;
  }

  // Numbers the wedges in the order of their first corners.
  void number_wedges() {
    std::uint32_t wedges = 0;
    for (Corner c = 0; c < corners_; ++c) {
      if (wedge_[c] == kNotNumbered) number(c, wedges++);
    }
    at_.resize(wedges);
    is_known_.resize(wedges, false);
  }

  // Assigns `wedge` to all corners around the vertex of c that are not separated from c by a seam.
  void number(Corner c, std::uint32_t wedge) {
    wedge_[c] = wedge;
    // The step from d to swing(d) crosses the edge opposite to next(d).
    for (Corner d = c; !is_seam_[next(d)];) {
      d = mesh_.swing(d);
      if (wedge_[d] == wedge) return;
      wedge_[d] = wedge;
    }
    for (Corner d = c; !is_seam_[prev(d)];) {
      d = prev(mesh_.opposite(prev(d)));
      if (wedge_[d] == wedge) return;
      wedge_[d] = wedge;
    }
  }

  // Codes the coordinates of the face of corner c. Then codes, breadth first, all faces connected
  // with it across edges that are not seams. Returns false if a coordinate is out of bounds.
  bool code_from(Corner c) {
    queue_ = {c};
    for (std::size_t i = 0; i < queue_.size(); ++i) {
      for (Corner d : {queue_[i], next(queue_[i]), prev(queue_[i])}) {
        if (!is_known(d) && !code_wedge(d)) return false;
      }
      for (Corner d : {queue_[i], next(queue_[i]), prev(queue_[i])}) {
        const Corner across = mesh_.opposite(d);
        if (!is_seam_[d] && !is_known(across)) queue_.push_back(across);
      }
    }
    return true;
  }

  // Codes the coordinates of the wedge of corner c.
  bool code_wedge(Corner c) {
    const Corner n = next(c), p = prev(c);
    const int known = (is_known(n) ? 1 : 0) + (is_known(p) ? 1 : 0);
    const Vec2 expected = known == 2   ? third_corner(at(n), at(p), to(n, p), to(n, c))
                          : known == 1 ? at(is_known(n) ? n : p)
                                       : to_vec2(last_);
    const Vec2i told = Coder::kEncodes ? told_at(c) : Vec2i{};
    const Vec2i coded = model_[static_cast<std::size_t>(known)].code(coder_, expected, told);
    const std::int32_t most = static_cast<std::int32_t>(kMaxAtlasSide) >> shift_;
    if (std::min(coded.x, coded.y) < 0 || std::max(coded.x, coded.y) > most) return false;
    if (known == 0) last_ = coded;
    at_[wedge_[c]] = coded;
    is_known_[wedge_[c]] = true;
    return true;
  }

  bool is_known(Corner c) const { return is_known_[wedge_[c]]; }
  Vec2 at(Corner c) const { return to_vec2(at_[wedge_[c]]); }
  // Subtracts in floating point. Damaged positions may be any integers, so their difference may not
  // fit into 32 bits.
  Vec3 to(Corner from, Corner c) const {
    return to_vec3(positions_[mesh_.vertex(c)]) - to_vec3(positions_[mesh_.vertex(from)]);
  }

  Expected<BaseAtlas> finished() const {
    BaseAtlas atlas;
    for (Corner c = 0; c < corners_; c += 3)
      atlas.wedges.push_back({wedge_[c], wedge_[c + 1], wedge_[c + 2]});
    for (const Vec2i& at : at_)
      atlas.coordinates.push_back({at.x << shift_, at.y << shift_});
    return atlas;
  }

  const Connectivity& mesh_;
  const std::vector<Vec3i>& positions_;
  // Number of corners of real faces. Corners from this number on belong to the faces that close
  // boundary loops.
  const Corner corners_;
  const BaseAtlas& truth_;
  Coder& coder_;
  std::vector<bool> is_seam_;         // per corner: whether the edge opposite to it is a seam
  std::vector<std::uint32_t> wedge_;  // per corner: its wedge
  std::vector<Vec2i> at_;             // per wedge, in units of 2^shift
  std::vector<bool> is_known_;        // per wedge: whether it is coded already
  std::vector<Corner> queue_;         // faces still to be coded by code_from()
  std::array<AdaptiveBit, 3> seam_;
  std::array<PairModel, 3> model_;  // indexed by how many of the face's other two corners are known
  Vec2i last_;                      // the first coordinates of the previous chart
  std::uint32_t shift_ = 0;         // all coordinates are multiples of 2^shift
};

Expected<Connectivity> connectivity_of(const BaseMesh& base) {
  return Connectivity::close(static_cast<std::uint32_t>(base.positions.size()), base.faces);
}

}  // namespace

std::vector<std::uint8_t> encode_atlas(const BaseMesh& base) {
  RangeEncoder coder;
  const auto mesh = connectivity_of(base);
  AtlasPass<RangeEncoder>(*mesh, base, base.atlas, coder).run();
  return coder.finish();
}

Expected<BaseAtlas> decode_atlas(std::span<const std::uint8_t> bytes, const BaseMesh& base) {
  RangeDecoder coder(bytes);
  const auto mesh = connectivity_of(base);
  if (!mesh) return tl::unexpected(mesh.error());
  const BaseAtlas none;
  return AtlasPass<RangeDecoder>(*mesh, base, none, coder).run();
}

}  // namespace vitrine::inline codec
