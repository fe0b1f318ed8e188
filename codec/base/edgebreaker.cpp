// SPDX-License-Identifier: Apache-2.0
#include "codec/base/edgebreaker.h"

#include <algorithm>
#include <utility>

#include "codec/base/rans.h"
#include "codec/format/base_mesh.h"

namespace vitrine::inline codec {
namespace {

constexpr std::uint8_t kStandard = 0;  // the only variant of the edgebreaker method that is read

// How a new face adjoins the part of the surface that is already built: the symbols of
// [Rossignac99].
enum Symbol : std::uint32_t { kC = 0, kS = 1, kL = 3, kR = 5, kE = 7 };

// A boundary edge of the face `source` to which a later face, `join`, is glued. `join` has the
// symbol S. Such edges occur on surfaces with handles or boundary loops. `source` and `join` are
// indices of symbols, counted from the last symbol.
struct LateEdge {
  std::uint32_t source = 0, join = 0;
  // If true, the edge is opposite to the second corner of `source`; if false, to the third corner.
  bool is_next = false;
};

// Adds faces to a surface whose boundary grows and shrinks. Each part of the surface has an active
// edge, where the next face is added. Every function returns false if the face does not fit.
class FaceBuilder {
 public:
  // `vertices` is the largest number of vertices that may be added, including vertices that are
  // later merged with others. `faces` is the number of all faces, and `symbols` the number of faces
  // that have a symbol.
  FaceBuilder(std::uint32_t vertices, std::uint32_t faces, std::uint32_t symbols)
      : late_corner_(symbols, kNoCorner), symbols_(symbols) {
    table_.vertex.resize(3 * std::size_t{faces}, kNoCorner);
    table_.opposite = table_.vertex;
    table_.leftmost.resize(vertices, kNoCorner);
  }

  bool read_late_edges(ByteReader& in);
  bool add(std::uint32_t symbol);
  bool add_first_faces(RansBits& is_inner);
  // Numbers the vertices in the order in which Draco numbers its points.
  bool number_vertices(bool has_attributes);
  CornerTable take() { return std::move(table_); }

 private:
  bool begin(Corner x);
  bool extend(Corner x, bool is_right);
  bool fill(Corner x);
  bool join(Corner x);
  bool keep_late_edges();
  std::vector<VertexId> numbered(bool has_attributes) const;

  bool is_free(Corner c) const { return c != kNoCorner && table_.opposite[c] == kNoCorner; }
  bool are_free(Corner a, Corner b) const { return a != b && is_free(a) && is_free(b); }
  bool is_removed(VertexId v) const { return table_.leftmost[v] == kNoCorner; }
  void glue(Corner a, Corner b) {
    table_.opposite[a] = b;
    table_.opposite[b] = a;
  }
  bool add_vertex(Corner c) {
    if (vertices_ == table_.vertex_count()) return false;
    table_.leftmost[vertices_] = c;
    table_.vertex[c] = vertices_++;
    return true;
  }
  // Returns the corner opposite to the boundary edge that starts at the vertex of c.
  Corner boundary_at(Corner c) const {
    const Corner left = table_.leftmost[table_.vertex[c]];
    return left == kNoCorner ? kNoCorner : next(left);
  }

  CornerTable table_;
  std::vector<Corner> active_;  // per part: the corner opposite to its active edge
  std::vector<VertexId> removed_;
  std::vector<LateEdge> late_;       // in ascending order of `source`; used from the end
  std::vector<Corner> late_corner_;  // per symbol S: the corner opposite to its LateEdge
  std::uint32_t symbols_, faces_ = 0, vertices_ = 0;
};

// Reads the late edges, which are stored in ascending order of `source`.
bool FaceBuilder::read_late_edges(ByteReader& in) {
  const std::uint64_t count = in.varint32();
  if (count > in.left() / 2) return false;
  late_.resize(static_cast<std::size_t>(count));
  std::uint64_t source = 0;
  for (LateEdge& edge : late_) {
    source += in.varint32();
    const std::uint64_t distance = in.varint32();
    if (source >= symbols_ || distance > source) return false;
    edge.source = static_cast<std::uint32_t>(source);
    edge.join = static_cast<std::uint32_t>(source - distance);
  }
  PlainBits bits(in.bytes((late_.size() + 7) / 8));
  for (LateEdge& edge : late_)
    edge.is_next = bits.next(1) != 0;
  return in.is_ok();
}

bool FaceBuilder::add(std::uint32_t symbol) {
  const Corner x = 3 * faces_;
  if (symbol != kE && active_.empty()) return false;
  const bool fits = symbol == kC   ? fill(x)
                    : symbol == kS ? join(x)
                    : symbol == kE ? begin(x)
                                   : extend(x, symbol == kR);
  if (!fits || (symbol != kC && symbol != kS && !keep_late_edges())) return false;
  ++faces_;
  return true;
}

// Symbol E: adds the first face of a new part.
bool FaceBuilder::begin(Corner x) {
  active_.push_back(x);
  return add_vertex(x) && add_vertex(x + 1) && add_vertex(x + 2);
}

// Symbols L and R: adds a face at the active edge, with a new vertex.
bool FaceBuilder::extend(Corner x, bool is_right) {
  const Corner a = active_.back();
  const Corner tip = is_right ? x + 2 : x + 1;
  if (!is_free(a) || !add_vertex(tip)) return false;
  glue(tip, a);
  const VertexId v = table_.vertex[prev(a)];
  table_.vertex[next(tip)] = v;
  table_.leftmost[v] = next(tip);
  table_.vertex[prev(tip)] = table_.vertex[next(a)];
  active_.back() = x;
  return true;
}

// Symbol C: adds a face between the active edge and the next boundary edge. The common vertex of
// these two edges leaves the boundary.
bool FaceBuilder::fill(Corner x) {
  const Corner a = active_.back(), b = boundary_at(next(a));
  if (!are_free(a, b)) return false;
  const VertexId v = table_.vertex[next(a)];
  const VertexId before = table_.vertex[prev(a)], behind = table_.vertex[next(b)];
  if (v == before || v == behind) return false;
  glue(a, x + 1);
  glue(b, x + 2);
  table_.vertex[x] = v;
  table_.vertex[x + 1] = behind;
  table_.vertex[x + 2] = before;
  table_.leftmost[before] = x + 2;
  active_.back() = x;
  return true;
}

// Symbol S: adds a face between the active edges of two parts, or between an active edge and a late
// edge. Merges one end of the first edge with one end of the second edge.
bool FaceBuilder::join(Corner x) {
  const Corner b = active_.back();
  active_.pop_back();
  if (late_corner_[faces_] != kNoCorner) active_.push_back(late_corner_[faces_]);
  if (active_.empty()) return false;
  const Corner a = active_.back();
  if (!are_free(a, b)) return false;
  glue(a, x + 2);
  glue(b, x + 1);
  const VertexId stays = table_.vertex[prev(a)], goes = table_.vertex[next(b)];
  const VertexId before = table_.vertex[prev(b)];
  table_.vertex[x] = stays;
  table_.vertex[x + 1] = table_.vertex[next(a)];
  table_.vertex[x + 2] = before;
  table_.leftmost[before] = x + 2;
  table_.leftmost[stays] = table_.leftmost[goes];
  const Corner first = next(b);
  for (Corner c = first; c != kNoCorner;) {
    table_.vertex[c] = stays;
    c = table_.swing_left(c);
    if (c == first) return false;
  }
  table_.leftmost[goes] = kNoCorner;
  removed_.push_back(goes);
  active_.back() = x;
  return true;
}

// Stores in late_corner_ the late edges of the face that is being added.
bool FaceBuilder::keep_late_edges() {
  const std::uint32_t face = symbols_ - faces_ - 1;
  while (!late_.empty() && late_.back().source >= face) {
    const LateEdge edge = late_.back();
    if (edge.source > face) return false;
    late_.pop_back();
    const Corner a = active_.back();
    late_corner_[symbols_ - edge.join - 1] = edge.is_next ? next(a) : prev(a);
  }
  return true;
}

// Adds the faces at which parts began. A part began at a boundary edge or at an inner face. An
// inner face has no symbol. It fills the last hole of its part, which has three edges.
bool FaceBuilder::add_first_faces(RansBits& is_inner) {
  for (; !active_.empty(); active_.pop_back()) {
    if (!is_inner.next()) continue;
    const Corner x = 3 * faces_, a = active_.back(), b = boundary_at(next(a));
    if (x == table_.vertex.size() || !are_free(a, b)) return false;
    const Corner c = boundary_at(next(b));
    if (!are_free(a, c) || b == c) return false;
    table_.vertex[x] = table_.vertex[next(b)];
    table_.vertex[x + 1] = table_.vertex[next(c)];
    table_.vertex[x + 2] = table_.vertex[next(a)];
    glue(x, a);
    glue(x + 1, b);
    glue(x + 2, c);
    ++faces_;
  }
  return faces_ == table_.face_count();
}

bool FaceBuilder::number_vertices(bool has_attributes) {
  const std::vector<VertexId> kept = numbered(has_attributes);
  std::vector<VertexId> number(table_.leftmost.size(), kNoCorner);
  std::vector<Corner> leftmost;
  leftmost.reserve(kept.size());
  for (const VertexId v : kept) {
    number[v] = static_cast<VertexId>(leftmost.size());
    leftmost.push_back(table_.leftmost[v]);
  }
  table_.leftmost = std::move(leftmost);
  for (VertexId& v : table_.vertex)
    v = number[v];
  return std::find(table_.vertex.begin(), table_.vertex.end(), kNoCorner) == table_.vertex.end();
}

// Returns the vertices that were not merged into others, in the order of Draco's points. If there
// are attributes, later vertices move up into the place of a removed vertex. If not, the last
// vertex takes this place.
std::vector<VertexId> FaceBuilder::numbered(bool has_attributes) const {
  std::vector<VertexId> at;
  for (VertexId v = 0; v < vertices_; ++v) {
    if (!has_attributes || !is_removed(v)) at.push_back(v);
  }
  if (has_attributes) return at;
  for (const VertexId gone : removed_) {
    while (!at.empty() && is_removed(at.back()))
      at.pop_back();
    if (at.size() <= gone) continue;
    at[gone] = at.back();
    at.pop_back();
  }
  return at;
}

// Whether an attribute has no seam. A seam is an edge whose two faces have different values of the
// attribute at an end of the edge.
bool is_seamless(const CornerTable& table, RansBits is_seam) {
  for (Corner c = 0; c < table.vertex.size(); ++c) {
    const Corner across = table.opposite[c];
    if (across != kNoCorner && across / 3 >= c / 3 && is_seam.next()) return false;
  }
  return true;
}

std::uint32_t next_symbol(PlainBits& bits) {
  return bits.next(1) == 0 ? std::uint32_t{kC} : bits.next(2) << 1 | 1;
}

}  // namespace

Expected<CornerTable> read_connectivity(ByteReader& in, const BaseCounts& counts) {
  if (in.u8() != kStandard)
    return fail(ErrorCode::kUnsupported,
                "the base mesh uses another variant of edgebreaker; build the model again");
  const std::uint64_t vertices = in.varint32(), faces = in.varint32();
  if (vertices != counts.vertices || faces != counts.faces || in.u8() != counts.attributes)
    return damaged_base("its counts are not those of the header");
  // Each symbol has at least one bit, so the number of remaining bytes bounds the number of symbols
  // and the memory to allocate.
  const std::uint64_t symbols = in.varint32(), joins = in.varint32();
  if (symbols > 8 * std::uint64_t{in.left()} || symbols > faces || faces > symbols + symbols / 3 ||
      joins > symbols || vertices > 3 * faces)
    return damaged_base("its counts are impossible");
  FaceBuilder builder(counts.vertices + static_cast<std::uint32_t>(joins), counts.faces,
                      static_cast<std::uint32_t>(symbols));
  bool fits = builder.read_late_edges(in);
  PlainBits bits(read_sized(in));
  RansBits is_inner(in);
  ByteReader at_seams = in;
  for (std::uint32_t i = 0; i < counts.attributes; ++i)
    fits = fits && RansBits(in).is_ok();

  for (std::uint64_t i = 0; fits && i < symbols; ++i)
    fits = builder.add(next_symbol(bits)) && bits.is_ok();
  if (!fits || !in.is_ok() || !is_inner.is_ok() || !builder.add_first_faces(is_inner) ||
      !builder.number_vertices(counts.attributes != 0))
    return damaged_base("its faces do not fit");
  CornerTable table = builder.take();
  if (table.vertex_count() != counts.vertices)
    return damaged_base("its counts are not those of the header");
  for (std::uint32_t i = 0; i < counts.attributes; ++i) {
    if (!is_seamless(table, RansBits(at_seams)))
      return fail(ErrorCode::kUnsupported, "the base mesh has seams; build the model again");
  }
  return table;
}

}  // namespace vitrine::inline codec
