// SPDX-License-Identifier: Apache-2.0
// Reads PLY. The header lists the elements and their properties. Elements and properties with
// unknown names are skipped.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "codec/core/byte_cursor.h"
#include "codec/import/named_pictures.h"
#include "codec/import/ply_header.h"
#include "codec/import/ply_textures.h"
#include "codec/import/readers.h"
#include "codec/import/stated_colours.h"
#include "codec/import/text_cursor.h"

namespace vitrine::inline codec {
namespace {

class AsciiValues {
 public:
  AsciiValues(std::span<const std::uint8_t> bytes, std::uint64_t first_line)
      : text_(bytes, first_line) {}

  bool has_failed() const { return has_failed_; }
  std::uint64_t most_values() const { return text_.left() / 2 + 1; }
  std::uint64_t line() const { return text_.line(); }
  bool has_decimal_comma() const { return text_.has_decimal_comma(); }

  double real(PlyType) {
    double value = 0;
    has_failed_ = has_failed_ || !text_.seek_word() || !text_.read_number(value);
    return value;
  }
  // Reads a count or an index. A value out of range becomes 0xFFFFFFFF, which later checks refuse.
  std::uint32_t index(PlyType) {
    const double value = real(PlyType::kFloat64);
    return value >= 0 && value < 4294967295.0 ? static_cast<std::uint32_t>(value) : 0xFFFF'FFFFu;
  }
  void skip(PlyType, std::uint64_t count) {
    for (; count > 0 && !has_failed_; --count)
      real(PlyType::kFloat64);
  }

 private:
  TextCursor text_;
  bool has_failed_ = false;
};

template <bool swap>
class BinaryValues {
 public:
  explicit BinaryValues(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  bool has_failed() const { return !bytes_.is_ok(); }
  std::uint64_t most_values() const { return bytes_.left(); }
  static std::uint64_t line() { return 0; }
  static bool has_decimal_comma() { return false; }

  double real(PlyType type) {
    if (type == PlyType::kFloat32) return bytes_.read<float>(swap);
    if (type == PlyType::kFloat64) return bytes_.read<double>(swap);
    if (type == PlyType::kUint64) return static_cast<double>(bytes_.read<std::uint64_t>(swap));
    return static_cast<double>(integer(type));
  }
  std::uint32_t index(PlyType type) {
    if (type == PlyType::kFloat32 || type == PlyType::kFloat64) {
      const double value = real(type);
      return value >= 0 && value < 4294967295.0 ? static_cast<std::uint32_t>(value) : 0xFFFF'FFFFu;
    }
    const std::int64_t value = integer(type);
    const bool fits = value >= 0 && value < 0xFFFF'FFFF;
    return fits ? static_cast<std::uint32_t>(value) : 0xFFFF'FFFFu;
  }
  void skip(PlyType type, std::uint64_t count) { bytes_.skip(count * byte_size(type)); }

 private:
  std::int64_t integer(PlyType type) {
    switch (type) {
      case PlyType::kInt8:
        return bytes_.read<std::int8_t>();
      case PlyType::kUint8:
        return bytes_.read<std::uint8_t>();
      case PlyType::kInt16:
        return bytes_.read<std::int16_t>(swap);
      case PlyType::kUint16:
        return bytes_.read<std::uint16_t>(swap);
      case PlyType::kInt32:
        return bytes_.read<std::int32_t>(swap);
      case PlyType::kInt64:
      case PlyType::kUint64:  // values above the range of int64 become negative
        return bytes_.read<std::int64_t>(swap);
      default:
        return bytes_.read<std::uint32_t>(swap);
    }
  }

  ByteReader bytes_;
};

// Largest number of unread properties or elements that a message names.
constexpr std::uint64_t kMostNamed = 4;

enum Slot { kX, kY, kZ, kRed, kGreen, kBlue, kU, kV, kPacked, kAlpha, kNowhere };

using SlotValues = std::array<double, kNowhere + 1>;

bool is_real(PlyType type) {
  return type == PlyType::kFloat32 || type == PlyType::kFloat64;
}

// Whether the property is a colour packed into one number, as the Point Cloud Library writes it.
// From the highest byte to the lowest, the number holds opacity, red, green and blue. A float
// property holds the same bits.
bool is_packed_colour(const PlyProperty& property) {
  const bool fits = property.type == PlyType::kInt32 || property.type == PlyType::kUint32 ||
                    property.type == PlyType::kFloat32;
  return fits && !property.is_list && (property.name == "rgba" || property.name == "rgb");
}

Colour unpacked(std::uint32_t bits) {
  return {static_cast<std::uint8_t>(bits >> 16), static_cast<std::uint8_t>(bits >> 8),
          static_cast<std::uint8_t>(bits)};
}

// Returns the bits of a packed colour. `value` is the number as read from the file.
std::uint32_t packed_bits(double value, bool is_float) {
  if (std::abs(value) > std::numeric_limits<float>::max()) return 0;
  if (is_float) return std::bit_cast<std::uint32_t>(static_cast<float>(value));
  return std::abs(value) < 4294967296.0
             ? static_cast<std::uint32_t>(static_cast<std::int64_t>(value))
             : 0;
}

Slot slot_of(const PlyProperty& property) {
  if (property.is_list) return kNowhere;
  const std::string& name = property.name;
  if (name == "x") return kX;
  if (name == "y") return kY;
  if (name == "z") return kZ;
  if (name == "red" || name == "r" || name == "diffuse_red") return kRed;
  if (name == "green" || name == "g" || name == "diffuse_green") return kGreen;
  if (name == "blue" || name == "b" || name == "diffuse_blue") return kBlue;
  if (name == "alpha" || name == "a" || name == "diffuse_alpha") return kAlpha;
  if (is_packed_colour(property)) return kPacked;
  if (is_vertex_u(property)) return kU;
  if (is_vertex_v(property)) return kV;
  return kNowhere;
}

bool is_byte(PlyType type) {
  return type == PlyType::kInt8 || type == PlyType::kUint8;
}

// Whether the type is an integer that holds colours up to 65535. Some programs write colours up to
// 255 with such a type.
bool is_wide_integer(PlyType type) {
  return !is_byte(type) && !is_real(type);
}

// Whether `opacity`, a value of this type, is less than full.
bool is_translucent_value(PlyType type, double opacity) {
  if (is_byte(type)) return opacity < 255;
  return is_wide_integer(type) ? opacity < 65535 && opacity != 255 : is_translucent(opacity);
}

// Whether no message about an unread property of a vertex is needed: the reader uses the property,
// or it is part of a normal, which can be computed from the faces.
bool is_known_of_vertex(const PlyProperty& property) {
  const std::string& name = property.name;
  return slot_of(property) != kNowhere || name == "nx" || name == "ny" || name == "nz";
}

// Describes which properties of a vertex the reader uses, and how.
struct VertexPlan {
  std::vector<Slot> slots;
  std::vector<PlyType> types;  // per property: the type with which it is read
  unsigned found = 0;          // bit n is set if a property of the file is read into slot n
  PlyType colour_type = PlyType::kUint8;
  PlyType alpha_type = PlyType::kUint8;
  bool has_normal = false;
  bool has_float_bits = false;  // whether packed colours are stored as floats
  bool has_packed_alpha = false;

  VertexPlan(const PlyElement& element, bool is_text) {
    for (const PlyProperty& property : element.properties) {
      const Slot slot = slot_of(property);
      const bool has_bits = slot == kPacked && property.type == PlyType::kFloat32;
      slots.push_back(slot);
      types.push_back(has_bits ? PlyType::kUint32 : property.type);
      has_float_bits = has_float_bits || (has_bits && is_text);
      found |= 1u << slot;
      has_normal = has_normal || property.name == "nx";
      has_packed_alpha = has_packed_alpha || (slot == kPacked && property.name == "rgba");
      if (slot == kRed) colour_type = property.type;
      if (slot == kAlpha) alpha_type = property.type;
    }
  }
  bool has_position() const { return (found & 7) == 7; }
  bool has_colour() const { return (found >> kRed & 7) == 7; }
  bool has_packed_colour() const { return !has_colour() && (found >> kPacked & 1) == 1; }
  bool has_alpha() const { return has_colour() && (found >> kAlpha & 1) == 1; }
  bool has_place() const { return (found >> kU & 3) == 3; }
};

template <class Values>
class BodyReader {
 public:
  BodyReader(const PlyHeader& header, const Values& values, const ReadOptions& options)
      : header_(header),
        values_(values),
        pictures_(options.beside, options.limits),
        found_(find_pictures(header, pictures_)),
        textures_(header, pictures_) {
    mesh_.format = "PLY";
  }

  Expected<RawMesh> read() {
    for (const PlyElement& element : header_.elements) {
      auto ok = read_element(element);
      if (!ok) return tl::unexpected(ok.error());
    }
    report_unread_elements();
    finish_texture();
    if (has_wide_faces_) face_colours_.scale_wide_integers();
    face_colours_.give_to(mesh_);
    textures_.give_to(mesh_);
    return std::move(mesh_);
  }

 private:
  void finish_texture() {
    if (!means_.empty() && mesh_.attributes.colours.empty()) {
      means_.resize(mesh_.positions.size());
      mesh_.attributes.colours = means_.take();
      mesh_.is_baked = true;
      append(pictures_.report_decoded());
    }
    append(pictures_.report_faults());
  }

  void append(const std::vector<std::string>& lines) {
    mesh_.repairs.insert(mesh_.repairs.end(), lines.begin(), lines.end());
  }

  // Adds the colour of picture `number` at (u, v) to the mean colour of a vertex.
  void add_sample(std::uint32_t vertex, double u, double v, std::uint32_t number = 0) {
    const Picture* picture = number < found_.size() ? found_[number] : nullptr;
    if (picture == nullptr || vertex >= mesh_.positions.size()) return;
    means_.resize(mesh_.positions.size());
    means_.add(vertex, sample_upwards(*picture, u, v));
  }

  Expected<void> read_element(const PlyElement& element) {
    if (element.properties.empty()) return {};
    if (element.name == "vertex") return read_vertices(element);
    if (element.name == "face") return read_faces(element, "vertex_ind", &BodyReader::face_of);
    if (element.name == "tristrips") {
      return read_faces(element, "vertex_ind", &BodyReader::strip_of);
    }
    note_unread(element);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      for (const PlyProperty& property : element.properties)
        skip(property);
      if (values_.has_failed()) return cut_short(element, i);
    }
    return {};
  }

  void note_unread(const PlyElement& element) {
    if (element.count == 0 || element.name == "camera" || element.name == "range_grid") return;
    if (element.name == "edge") {
      mesh_.repairs.push_back(counted(element.count, "edge") +
                              " not carried; convert what you need to faces");
      return;
    }
    unread_elements_ += element.count;
    if (unread_names_.size() < kMostNamed) unread_names_.push_back(in_quotes(element.name));
  }

  void report_unread_elements() {
    if (unread_elements_ == 0) return;
    std::string names;
    for (const std::string& name : unread_names_)
      names += (names.empty() ? "" : ", ") + name;
    mesh_.repairs.push_back(counted(unread_elements_, "element") + " of other kinds (" + names +
                            ") not carried; export what you need as faces and vertex colours");
  }

  Expected<void> read_vertices(const PlyElement& element) {
    const VertexPlan plan(element, header_.format == PlyFormat::kAscii);
    if (!plan.has_position())
      return bad_input("the PLY vertices lack a property x, y or z; export them with positions");
    if (!mesh_.positions.empty())
      return bad_input("the PLY file has two vertex elements; export it again with one");
    mesh_.has_seams = plan.has_place() || plan.has_normal;
    mesh_.positions.reserve(element.count);
    std::vector<StatedColour> stated;
    for (std::uint64_t i = 0; i < element.count; ++i) {
      SlotValues row;
      for (std::size_t p = 0; p < plan.slots.size(); ++p) {
        const PlyProperty& property = element.properties[p];
        if (property.is_list) {
          skip(property);
        } else {
          row[plan.slots[p]] = values_.real(plan.types[p]);
        }
      }
      if (values_.has_failed()) return cut_short(element, i);
      mesh_.positions.push_back({row[kX], row[kY], row[kZ]});
      add_colour(plan, row, stated);
      if (plan.has_place() && found_.size() == 1) {
        add_sample(static_cast<std::uint32_t>(i), row[kU], row[kV]);
      }
      if (plan.has_place() && !textures_.empty())
        mesh_.vertex_coordinates[0].push_back(from_upwards(row[kU], row[kV]));
    }
    if (is_wide_integer(plan.colour_type)) scale_wide_integers(stated);
    if (!stated.empty()) mesh_.attributes.colours = to_colours(stated, mesh_.repairs);
    report_unread(element);
    return {};
  }

  void report_unread(const PlyElement& element) {
    std::string names;
    std::uint64_t count = 0;
    for (const PlyProperty& property : element.properties) {
      if (is_known_of_vertex(property)) continue;
      if (++count <= kMostNamed) names += (names.empty() ? "" : ", ") + in_quotes(property.name);
    }
    if (count > 0)
      mesh_.repairs.push_back(counted(count, "kind") + " of values at the vertices not carried: " +
                              names + "; to show them, bake them into colours");
  }

  // Adds a vertex colour to the mesh. Adds it to `stated` instead if its range is known only after
  // the last vertex: floats are up to 1 or up to 255, wide integers up to 65535 or up to 255.
  void add_colour(const VertexPlan& plan, const SlotValues& row,
                  std::vector<StatedColour>& stated) {
    std::vector<Colour>& colours = mesh_.attributes.colours;
    if (plan.has_alpha())
      mesh_.translucent_colours += is_translucent_value(plan.alpha_type, row[kAlpha]);
    if (plan.has_packed_colour()) {
      const std::uint32_t bits = packed_bits(row[kPacked], plan.has_float_bits);
      colours.push_back(unpacked(bits));
      mesh_.translucent_colours += plan.has_packed_alpha && bits >> 24 != 255;
    } else if (plan.has_colour() && is_byte(plan.colour_type)) {
      colours.push_back(
          {to_byte(row[kRed] / 255), to_byte(row[kGreen] / 255), to_byte(row[kBlue] / 255)});
    } else if (plan.has_colour()) {
      stated.push_back(stated_colour(row));
    }
  }

  static StatedColour stated_colour(const SlotValues& row) {
    return {static_cast<float>(row[kRed]), static_cast<float>(row[kGreen]),
            static_cast<float>(row[kBlue])};
  }

  // Reads the lists of vertex indices in an element, and passes each list to `add`. The property
  // with the lists has a name that starts with `list`.
  Expected<void> read_faces(const PlyElement& element, std::string_view list,
                            void (BodyReader::*add)(const std::vector<std::uint32_t>&)) {
    if (element.name == "face") mesh_.reserve_faces(element.count);
    bool has_list = false;
    for (const PlyProperty& p : element.properties) {
      has_list = has_list || (p.is_list && p.name.starts_with(list));
      has_wide_faces_ = has_wide_faces_ || (slot_of(p) == kRed && is_wide_integer(p.type));
      if (p.name == "texcoord" && !uses_places()) {
        mesh_.repairs.push_back("texture coordinates of " + counted(element.count, "face") +
                                " not carried; to use them, name the picture in a comment "
                                "TextureFile");
      }
    }
    if (!has_list)
      return bad_input("the PLY faces have no list vertex_indices; export them with one");
    for (std::uint64_t i = 0; i < element.count; ++i) {
      read_row(element, list);
      if (values_.has_failed()) return cut_short(element, i);
      if (!row_.has_corners) continue;
      if (row_.colour_parts == 7) {
        face_colours_.add(row_.corners, row_.colour);
        mesh_.translucent_colours += row_.is_translucent;
      }
      apply_places();
      (this->*add)(row_.corners);
    }
    return {};
  }

  // Whether the reader needs the texture coordinates of corners.
  bool uses_places() const { return !textures_.empty(); }

  void read_row(const PlyElement& element, std::string_view list) {
    row_.clear();
    for (const PlyProperty& property : element.properties) {
      if (is_texcoord(property) && uses_places()) {
        read_places(property);
      } else if (is_texnumber(property) && uses_places()) {
        row_.texnumber = values_.index(property.type);
      } else if (property.is_list && property.name.starts_with(list)) {
        row_.has_corners = read_list(property, row_.corners);
      } else if (const Slot slot = slot_of(property); slot >= kRed && slot <= kBlue) {
        const auto part = static_cast<std::size_t>(slot - kRed);
        const double value = values_.real(property.type);
        row_.colour[part] = static_cast<float>(is_byte(property.type) ? value / 255 : value);
        row_.colour_parts |= 1u << part;
      } else if (slot == kAlpha) {
        row_.is_translucent = is_translucent_value(property.type, values_.real(property.type));
      } else {
        skip(property);
      }
    }
    if (row_.places.size() != row_.corners.size()) row_.places.clear();
  }

  bool read_list(const PlyProperty& property, std::vector<std::uint32_t>& corners) {
    const std::uint32_t count = values_.index(property.count_type);
    if (count > values_.most_values()) return values_.skip(property.type, ~0u), false;
    corners.resize(count);
    for (std::uint32_t& corner : corners)
      corner = values_.index(property.type);
    return !values_.has_failed();
  }

  // Reads the texture coordinates u and v of each corner of a face.
  void read_places(const PlyProperty& property) {
    const std::uint32_t count = values_.index(property.count_type);
    if (count > values_.most_values()) return values_.skip(property.type, ~0u);
    row_.places.resize(count / 2);
    for (auto& [u, v] : row_.places)
      u = values_.real(property.type), v = values_.real(property.type);
    values_.skip(property.type, count % 2);
  }

  // Adds the picture's colours at the row's corners to the mean colours of the vertices. Stores the
  // corners' texture coordinates for the mesh.
  void apply_places() {
    at_corners_.clear();
    for (std::size_t i = 0; i < row_.places.size(); ++i) {
      const auto [u, v] = row_.places[i];
      add_sample(row_.corners[i], u, v, row_.texnumber);
      if (!textures_.empty()) at_corners_.push_back(from_upwards(u, v));
    }
    if (!textures_.empty()) mesh_.use_material(textures_.material_of(row_.texnumber));
  }

  void face_of(const std::vector<std::uint32_t>& corners) {
    mesh_.add_face(corners, values_.line(), at_corners_);
  }

  // Adds a triangle strip. Every other triangle is reversed, so that all face the same way. The
  // index -1 starts a new strip.
  void strip_of(const std::vector<std::uint32_t>& strip) {
    std::size_t start = 0;
    for (std::size_t i = 0; i < strip.size(); ++i) {
      if (strip[i] == 0xFFFF'FFFFu) {
        start = i + 1;
      } else if (i >= start + 2) {
        const bool odd = (i - start) % 2 == 1;
        mesh_.add_triangle({strip[i - 2 + odd], strip[i - 1 - odd], strip[i]}, values_.line());
      }
    }
  }

  void skip(const PlyProperty& property) {
    values_.skip(property.type, property.is_list ? values_.index(property.count_type) : 1);
  }

  Unexpected cut_short(const PlyElement& element, std::uint64_t i) const {
    const std::string place = values_.line() == 0
                                  ? "the PLY file"
                                  : "PLY line " + std::to_string(values_.line()) + ": the file";
    if (values_.has_decimal_comma())
      return bad_input("PLY line " + std::to_string(values_.line()) + ": " +
                       std::string(kDecimalCommas));
    return bad_input(place + " ends or has no number in " + in_quotes(element.name) + ' ' +
                     std::to_string(i) + " of " + std::to_string(element.count) +
                     "; it is cut short or damaged, copy it again");
  }

  const PlyHeader& header_;
  Values values_;
  // The values that the reader takes from one face or strip.
  struct FaceRow {
    std::vector<std::uint32_t> corners;
    std::vector<std::array<double, 2>> places;  // texture coordinates per corner, or empty
    std::uint32_t texnumber = 0;
    bool has_corners = false;
    StatedColour colour{};
    unsigned colour_parts = 0;  // bit k is set if this row has component k of `colour`
    bool is_translucent = false;

    void clear() {
      corners.clear(), places.clear();
      texnumber = 0, has_corners = false, colour_parts = 0, is_translucent = false;
    }
  };

  NamedPictures pictures_;
  // The pictures that give the vertex colours, by number. An entry may be null.
  std::vector<const Picture*> found_;
  PlyTextures textures_;
  FaceColours face_colours_;
  bool has_wide_faces_ = false;                 // whether colours of faces are wide integers
  std::uint64_t unread_elements_ = 0;           // number of elements of unknown kinds
  std::vector<std::string> unread_names_;       // the first few of their kinds
  ColourMeans means_;                           // mean picture colour per vertex; may be empty
  FaceRow row_;                                 // the row being read
  std::vector<TextureCoordinates> at_corners_;  // texture coordinates of the face; may be empty
  RawMesh mesh_;
};

}  // namespace

bool is_ply(std::span<const std::uint8_t> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::size_t end = text.find_first_not_of(" \t", 3);
  return lower_case(text.substr(0, 3)) == "ply" && end != text.npos &&
         (text[end] == '\r' || text[end] == '\n');
}

Expected<RawMesh> read_ply(std::span<const std::uint8_t> bytes, const ReadOptions& options) {
  const auto header = parse_ply_header(bytes);
  if (!header) return tl::unexpected(header.error());
  const auto body = bytes.subspan(header->data_begin);
  switch (header->format) {
    case PlyFormat::kAscii:
      return BodyReader<AsciiValues>(*header, {body, header->line_count + 1}, options).read();
    case PlyFormat::kLittleEndian:
      return BodyReader<BinaryValues<false>>(*header, BinaryValues<false>(body), options).read();
    default:
      return BodyReader<BinaryValues<true>>(*header, BinaryValues<true>(body), options).read();
  }
}

}  // namespace vitrine::inline codec
