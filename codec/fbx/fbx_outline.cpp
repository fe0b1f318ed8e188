// SPDX-License-Identifier: Apache-2.0
#include "codec/fbx/fbx_outline.h"

#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "codec/core/byte_cursor.h"
#include "codec/core/parse_number.h"
#include "codec/fbx/fbx_links.h"

namespace vitrine::inline codec {
namespace {

constexpr int kDeepest = 64;
constexpr std::size_t kValues = 5;  // number of values to keep per record
constexpr std::uint64_t kMostDecodedPerByte = 1024;
constexpr std::uint64_t kMostSplitting = std::uint64_t{1} << 33;
// Names of two records of a mesh: the corners of all faces, and the material index of each face.
constexpr std::string_view kCorners = "PolygonVertexIndex", kMaterials = "Materials";
constexpr std::string_view kBinaryStart = "Kaydara FBX Binary  ";

using Text = std::string_view;

Unexpected bad_fbx(Text fault) {
  return fail(ErrorCode::kBadInput,
              "the FBX is damaged: " + std::string(fault) + "; export the file again");
}

// A value of a record: text, or a number.
struct FbxValue {
  Text text;
  double number = 0;
  std::int64_t id = 0;
};

// Returns the id at the start of a text. Handles overflow as the importer does, so that both read
// the same id from any text.
std::int64_t id_in(Text text) {
  std::uint64_t id = 0;
  for (const char c : text) {
    if (c < '0' || c > '9') break;
    const std::uint64_t longer = id * 10 + static_cast<std::uint64_t>(c - '0');
    if (longer < id) return 0;
    id = longer;
  }
  return static_cast<std::int64_t>(id);
}

// Collects facts from the records of a file.
class FbxFacts {
 public:
  // Takes a record and its first values. `top` is the name of the outermost record around this
  // record, and `depth` is the number of records around it.
  void add(Text top, int depth, Text name, std::span<const FbxValue> values) {
    if (top == "GlobalSettings" && name == "P" && values.size() > 4) add_setting(values);
    if (top == "Connections" && is_link(values))
      links_.add_link(values[1].id, values[2].id, is_to_property(values));
    if (top == "Objects" && name == "P") links_.add_property();
    if (top != "Objects" || values.size() < 3) return;
    if (depth == 1) end_object(), links_.add_object(values[0].id, name);
    if (name == "AnimationStack") ++outline_.animations;
    if (name == "Deformer" && values[2].text == "Skin") ++outline_.skins;
    if (name == "Deformer" && values[2].text == "BlendShape") ++outline_.morphs;
  }

  // Count the corners and the material indices of a mesh. For each different index, the importer
  // visits all faces and creates a part of the mesh.
  void add_corners(std::uint64_t count) { faces_ += count; }
  template <class Index>
  void add_materials(std::vector<Index> indices) {
    faces_ += indices.size();
    std::ranges::sort(indices);
    const auto end = std::unique(indices.begin(), indices.end());
    parts_ += static_cast<std::uint64_t>(end - indices.begin());
  }

  Expected<FbxOutline> finish(std::uint64_t decoded_bytes) {
    end_object();
    if (splitting_ > kMostSplitting) return bad_fbx("its meshes have too many materials");
    if (const Text fault = links_.fault(most_parts_); !fault.empty()) return bad_fbx(fault);
    outline_.decoded_bytes = decoded_bytes;
    return outline_;
  }

 private:
  // Whether the importer treats the values as a link to an object. It does so for every kind of
  // link, except links between two properties ("PP").
  static bool is_link(std::span<const FbxValue> values) {
    return values.size() >= 3 && values[0].text != "PP";
  }

  static bool is_to_property(std::span<const FbxValue> values) {
    return values[0].text == "OP" && values.size() >= 4 && !values[3].text.empty();
  }

  void add_setting(std::span<const FbxValue> values) {
    if (values[0].text == "UnitScaleFactor") outline_.centimetres = values[4].number;
    if (values[0].text == "UpAxis" && values[4].number >= 0 && values[4].number <= 2)
      outline_.up_axis = static_cast<int>(values[4].number);
  }

  void end_object() {
    if (parts_ > 1) splitting_ = std::min(splitting_ + parts_ * faces_, kMostSplitting + 1);
    most_parts_ = std::max(most_parts_, parts_);
    links_.add_mesh(parts_, faces_);
    parts_ = faces_ = 0;
  }

  FbxOutline outline_;
  FbxLinks links_;
  std::uint64_t parts_ = 0, faces_ = 0;  // counts for the current object; faces_ is an upper bound
  std::uint64_t splitting_ = 0, most_parts_ = 1;
};

// Walks the records of a binary file. A record holds its end position, the number and size of its
// values, its name, the values, and then nested records.
class BinaryFbx {
 public:
  explicit BinaryFbx(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  Expected<FbxOutline> read() {
    constexpr std::size_t kVersion = 23, kFirstRecord = 27, kLargeRecords = 7500;
    if (bytes_.size() < kFirstRecord) return bad_fbx("it ends within its header");
    is_large_ = load<std::uint32_t>(&bytes_[kVersion]) >= kLargeRecords;
    for (at_ = kFirstRecord; at_ < bytes_.size();) {
      bool is_end = false;
      if (!read_record(bytes_.size(), 0, {}, is_end))
        return bad_fbx("a record is cut or misplaced");
      if (is_end) break;
    }
    if (decoded_ > kMostDecodedPerByte * bytes_.size())
      return bad_fbx("its arrays are larger than their bytes can encode");
    return facts_.finish(decoded_ + bytes_.size());
  }

 private:
  // Takes `count` bytes. Returns false if fewer are left before `end`.
  bool take(std::uint64_t count, std::uint64_t end, std::uint64_t& begin) {
    begin = at_;
    if (at_ > end || count > end - at_) return false;
    at_ += count;
    return true;
  }

  template <class Number>
  bool take_number(std::uint64_t end, Number& number) {
    std::uint64_t begin = 0;
    if (!take(sizeof(Number), end, begin)) return false;
    number = load<Number>(&bytes_[begin]);
    return true;
  }

  bool take_word(std::uint64_t end, std::uint64_t& word) {
    if (is_large_) return take_number(end, word);
    std::uint32_t narrow = 0;
    if (!take_number(end, narrow)) return false;
    word = narrow;
    return true;
  }

  bool take_text(std::uint64_t size, std::uint64_t end, Text& text) {
    std::uint64_t begin = 0;
    if (!take(size, end, begin)) return false;
    text = {reinterpret_cast<const char*>(bytes_.data()) + begin, static_cast<std::size_t>(size)};
    return true;
  }

  // Reads a record that must end at or before `end`. An empty record ends a list of records.
  bool read_record(std::uint64_t end, int depth, Text top, bool& is_end) {
    std::uint64_t record_end = 0, count = 0, size = 0;
    std::uint8_t name_size = 0;
    Text name;
    if (depth > kDeepest || !take_word(end, record_end)) return false;
    is_end = record_end == 0;
    if (is_end) return true;
    if (!take_word(end, count) || !take_word(end, size) || !take_number(end, name_size) ||
        !take_text(name_size, end, name))
      return false;
    if (record_end > end || record_end < at_ || size > record_end - at_) return false;
    const std::uint64_t values_end = at_ + size;
    array_ = name;
    std::vector<FbxValue> values;
    for (std::uint64_t i = 0; i < count; ++i) {
      FbxValue value;
      if (!read_value(values_end, value)) return false;
      if (values.size() < kValues) values.push_back(value);
    }
    if (at_ != values_end) return false;
    facts_.add(top, depth, name, values);
    return read_inner(record_end, depth, top.empty() ? name : top);
  }

  // Reads the records nested in a record. An empty record ends the list.
  bool read_inner(std::uint64_t record_end, int depth, Text top) {
    const std::uint64_t empty_record = is_large_ ? 25 : 13;
    if (at_ == record_end) return true;
    if (record_end - at_ < empty_record) return false;
    const std::uint64_t last = record_end - empty_record;
    while (at_ < last) {
      bool is_end = false;
      if (!read_record(last, depth + 1, top, is_end) || is_end) return false;
    }
    const auto empty = bytes_.subspan(last, empty_record);
    at_ = record_end;
    return std::ranges::all_of(empty, [](std::uint8_t byte) { return byte == 0; });
  }

  bool read_value(std::uint64_t end, FbxValue& value) {
    std::uint8_t type = 0;
    if (!take_number(end, type)) return false;
    switch (type) {
      case 'Y':
        return take_as<std::int16_t>(end, value);
      case 'C':
      case 'B':
        return take_as<std::int8_t>(end, value);
      case 'I':
        return take_as<std::int32_t>(end, value);
      case 'L':
        return take_as<std::int64_t>(end, value);
      case 'F':
        return take_as<float>(end, value);
      case 'D':
        return take_as<double>(end, value);
      case 'S':
      case 'R': {
        std::uint32_t size = 0;
        return take_number(end, size) && take_text(size, end, value.text);
      }
      case 'f':
      case 'i':
        return take_array(end, 4);
      case 'd':
      case 'l':
        return take_array(end, 8);
      case 'b':
      case 'c':
        return take_array(end, 1);
      default:
        return false;
    }
  }

  template <class Number>
  bool take_as(std::uint64_t end, FbxValue& value) {
    Number number{};
    if (!take_number(end, number)) return false;
    value.number = static_cast<double>(number);
    if constexpr (std::is_integral_v<Number>) value.id = number;
    return true;
  }

  // Takes an array of numbers with `width` bytes each, plain or compressed.
  bool take_array(std::uint64_t end, std::uint64_t width) {
    std::uint32_t count = 0, encoding = 0, size = 0;
    std::uint64_t begin = 0;
    if (!take_number(end, count) || !take_number(end, encoding) || !take_number(end, size) ||
        !take(size, end, begin))
      return false;
    const std::uint64_t decoded = count * width;
    decoded_ += decoded;
    const bool is_packed = encoding == 1 && decoded <= kMostDecodedPerByte * size;
    if (!(encoding == 0 && decoded == size) && !(is_packed && decoded <= UINT32_MAX)) return false;
    if (array_ == kCorners) facts_.add_corners(count);
    if (array_ != kMaterials || width != sizeof(std::int32_t) || count == 0) return true;
    return take_materials(bytes_.subspan(begin, size), is_packed, count);
  }

  bool take_materials(std::span<const std::uint8_t> data, bool is_packed, std::uint32_t count) {
    std::vector<std::int32_t> indices(count);
    uLongf size = count * sizeof(std::int32_t);
    if (!is_packed)
      std::memcpy(indices.data(), data.data(), data.size());
    else if (::uncompress(reinterpret_cast<Bytef*>(indices.data()), &size, data.data(),
                          data.size()) != Z_OK)
      return false;
    facts_.add_materials(std::move(indices));
    return true;
  }

  std::span<const std::uint8_t> bytes_;
  std::uint64_t at_ = 0, decoded_ = 0;
  bool is_large_ = false;  // whether the sizes in records have 64 bits
  Text array_;             // name of the record whose values are read
  FbxFacts facts_;
};

// Walks the records of a text file. A record is a name, a colon and values separated by commas,
// then nested records in braces. A semicolon begins a comment. Line ends have no meaning.
class TextFbx {
 public:
  explicit TextFbx(Text text) : text_(text) {}

  Expected<FbxOutline> read() {
    for (at_ = 0; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == '\0') return bad_fbx("its text has a byte of zero");
      if (c == '*' && !has_believable_size(text_.substr(at_ + 1)))
        return bad_fbx("an array is larger than the file");
      if (c == ';')
        skip_comment();
      else if (c == '"' && !take_quoted())
        return bad_fbx("it is cut short");
      else if (c != '"')
        take(c);
      if (depth_ < 0 || depth_ > kDeepest)
        return bad_fbx("its braces do not match, or are too deep");
    }
    end_record();
    if (depth_ != 0) return bad_fbx("it is cut short");
    return facts_.finish(text_.size());
  }

 private:
  // Whether the array size at the start of the text is possible: at most the size of the file.
  bool has_believable_size(Text text) const {
    std::uint64_t count = 0;
    for (const char c : text.substr(0, 20)) {
      if (c < '0' || c > '9') break;
      count = count * 10 + static_cast<std::uint64_t>(c - '0');
    }
    return count <= text_.size();
  }

  void skip_comment() {
    end_word();
    at_ = std::min(text_.find_first_of("\r\n", at_), text_.size());
  }

  bool take_quoted() {
    end_word();
    const std::size_t end = text_.find('"', at_ + 1);
    if (end == text_.npos) return false;
    begin_word(text_.substr(at_ + 1, end - at_ - 1));
    at_ = end;
    return true;
  }

  // Takes a character outside of quotes and comments.
  void take(char c) {
    constexpr Text kBetween = " \t\r\n,:{}";
    if (kBetween.find(c) == kBetween.npos) {
      if (word_begin_ == Text::npos) word_begin_ = at_;
      return;
    }
    end_word();
    if (c == ':') {
      const Text name = std::exchange(pending_, {}).value_or(Text());
      end_record();
      name_ = name;
    }
    if (c == '{') begin_array();
    if (c == '{' || c == '}') end_record();
    depth_ += c == '{' ? 1 : c == '}' ? -1 : 0;
    if (c == '}' && depth_ <= array_depth_) end_array();
  }

  void begin_array() {
    if (depth_ >= array_depth_ || (name_ != kCorners && name_ != kMaterials)) return;
    array_ = name_;
    array_depth_ = depth_;
  }

  void end_array() {
    if (array_ == kCorners) facts_.add_corners(array_values_.size());
    if (array_ == kMaterials) facts_.add_materials(std::move(array_values_));
    array_values_.clear();
    array_ = {};
    array_depth_ = kDeepest;
  }

  void end_word() {
    if (word_begin_ == Text::npos) return;
    begin_word(text_.substr(word_begin_, at_ - word_begin_));
    word_begin_ = Text::npos;
  }

  // Keeps a word until the next character shows whether it is a name or a value.
  void begin_word(Text word) {
    end_value();
    pending_ = word;
  }

  void end_value() {
    if (pending_ && depth_ > array_depth_) array_values_.push_back(*pending_);
    if (pending_ && values_.size() < kValues) {
      values_.push_back({.text = *pending_,
                         .number = parse_number<double>(*pending_).value_or(0),
                         .id = id_in(*pending_)});
    }
    pending_.reset();
  }

  void end_record() {
    end_value();
    if (depth_ == 0 && !name_.empty()) top_ = name_;
    if (!name_.empty()) facts_.add(top_, depth_, name_, values_);
    name_ = {};
    values_.clear();
  }

  Text text_, top_, name_;
  std::size_t at_ = 0, word_begin_ = Text::npos;
  std::optional<Text> pending_;  // the last word, not yet known to be a name or a value
  std::vector<FbxValue> values_;
  Text array_;  // name of the array being read, or empty
  std::vector<Text> array_values_;
  int depth_ = 0, array_depth_ = kDeepest;
  FbxFacts facts_;
};

Text fbx_text(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

bool is_binary_fbx(std::span<const std::uint8_t> bytes) {
  return fbx_text(bytes).starts_with(kBinaryStart);
}

bool is_text_fbx(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kStart = 1024;
  const Text start = fbx_text(bytes).substr(0, kStart);
  return start.starts_with("; FBX") || start.find("FBXHeaderExtension:") != start.npos;
}

Expected<FbxOutline> outline_of_fbx(std::span<const std::uint8_t> bytes) {
  if (is_binary_fbx(bytes)) return BinaryFbx(bytes).read();
  return TextFbx(fbx_text(bytes)).read();
}

}  // namespace vitrine::inline codec
