// SPDX-License-Identifier: Apache-2.0
#include "codec/import/ply_header.h"

#include <array>
#include <charconv>
#include <optional>
#include <string_view>

#include "codec/import/text_cursor.h"
#include "codec/repair/raw_mesh.h"

namespace vitrine::inline codec {
namespace {

constexpr std::size_t kMostHeaderBytes = 1 << 20;
constexpr std::size_t kMostProperties = 1024;

struct TypeName {
  std::string_view name;
  PlyType type;
};

constexpr std::array<TypeName, 18> kTypeNames{{{"char", PlyType::kInt8},
                                               {"int8", PlyType::kInt8},
                                               {"uchar", PlyType::kUint8},
                                               {"uint8", PlyType::kUint8},
                                               {"short", PlyType::kInt16},
                                               {"int16", PlyType::kInt16},
                                               {"ushort", PlyType::kUint16},
                                               {"uint16", PlyType::kUint16},
                                               {"int", PlyType::kInt32},
                                               {"int32", PlyType::kInt32},
                                               {"uint", PlyType::kUint32},
                                               {"uint32", PlyType::kUint32},
                                               {"int64", PlyType::kInt64},
                                               {"uint64", PlyType::kUint64},
                                               {"float", PlyType::kFloat32},
                                               {"float32", PlyType::kFloat32},
                                               {"double", PlyType::kFloat64},
                                               {"float64", PlyType::kFloat64}}};

std::optional<PlyType> type_of(std::string_view name) {
  for (const TypeName& known : kTypeNames) {
    if (known.name == name) return known.type;
  }
  return std::nullopt;
}

std::string_view take_word(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(" \t"));
  line.remove_prefix(word.size());
  return word;
}

class HeaderParser {
 public:
  explicit HeaderParser(std::string_view text) : text_(text) {}

  Expected<PlyHeader> parse();

 private:
  bool take_line(std::string_view& line);
  Expected<void> statement(std::string_view line);
  Expected<void> format(std::string_view line);
  Expected<void> element(std::string_view line);
  Expected<void> property(std::string_view line);
  Expected<PlyType> type(std::string_view name) const;
  void comment(std::string_view line);

  Unexpected bad(std::string what) const {
    return bad_input("PLY header, line " + std::to_string(line_number_) + ": " + std::move(what) +
                     "; the file is damaged, export it again");
  }

  std::string_view text_;
  std::string_view line_end_ = "\n";
  std::size_t at_ = 0;
  std::size_t line_number_ = 0;
  std::size_t property_count_ = 0;
  bool has_format_ = false;
  PlyHeader header_;
};

bool HeaderParser::take_line(std::string_view& line) {
  const std::size_t end = text_.find(line_end_, at_);
  if (end == text_.npos) return false;
  line = text_.substr(at_, end - at_);
  at_ = end + line_end_.size();
  ++line_number_;
  while (line.ends_with('\r') || line.ends_with(' ') || line.ends_with('\t'))
    line.remove_suffix(1);
  return true;
}

Expected<void> HeaderParser::format(std::string_view line) {
  const std::string_view name = take_word(line);
  has_format_ = true;
  if (name == "ascii") return header_.format = PlyFormat::kAscii, Expected<void>{};
  if (name == "binary_little_endian") {
    return header_.format = PlyFormat::kLittleEndian, Expected<void>{};
  }
  if (name == "binary_big_endian") return header_.format = PlyFormat::kBigEndian, Expected<void>{};
  return bad("unknown format " + in_quotes(name));
}

Expected<void> HeaderParser::element(std::string_view line) {
  PlyElement element;
  element.name = take_word(line);
  const std::string_view count = take_word(line);
  const auto [end, error] =
      std::from_chars(count.data(), count.data() + count.size(), element.count);
  if (error != std::errc{} || end != count.data() + count.size()) {
    return bad("the count " + in_quotes(count) + " of element " + in_quotes(element.name) +
               " is not a number from 0 up that fits 64 bits");
  }
  header_.elements.push_back(std::move(element));
  return {};
}

// Some programs write the types long and ulong of C, which have no fixed size. In text, the size
// does not matter.
Expected<PlyType> HeaderParser::type(std::string_view name) const {
  if (const auto known = type_of(name)) return *known;
  if (name != "long" && name != "ulong") return bad("unknown type " + in_quotes(name));
  if (header_.format == PlyFormat::kAscii)
    return name == "long" ? PlyType::kInt64 : PlyType::kUint64;
  return bad_input("PLY header, line " + std::to_string(line_number_) + ": the type " +
                   in_quotes(name) + " has no fixed size; export the file as text");
}

Expected<void> HeaderParser::property(std::string_view line) {
  if (header_.elements.empty()) return bad("a property before the first element");
  if (++property_count_ > kMostProperties) return bad("more than 1024 properties");
  PlyProperty property{};
  std::string_view word = take_word(line);
  if (word == "list") {
    const auto of_count = type(take_word(line));
    if (!of_count) return tl::unexpected(of_count.error());
    property.is_list = true;
    property.count_type = *of_count;
    word = take_word(line);
  }
  const auto of_values = type(word);
  if (!of_values) return tl::unexpected(of_values.error());
  property.type = *of_values;
  property.name = lower_case(take_word(line));
  header_.elements.back().properties.push_back(std::move(property));
  return {};
}

void HeaderParser::comment(std::string_view line) {
  if (take_word(line) != "TextureFile") return;
  line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
  header_.textures.emplace_back(line.substr(0, line.find_last_not_of(" \t") + 1));
}

Expected<void> HeaderParser::statement(std::string_view line) {
  const std::string_view keyword = take_word(line);
  if (keyword == "format") return format(line);
  if (keyword == "element") return element(line);
  if (keyword == "property") return property(line);
  if (keyword == "comment") comment(line);
  if (keyword == "comment" || keyword == "obj_info" || keyword.empty()) return {};
  return bad("unknown keyword " + in_quotes(keyword));
}

Expected<PlyHeader> HeaderParser::parse() {
  const std::size_t end = std::min(text_.find_first_of("\r\n"), text_.size());
  if (text_.substr(end).starts_with('\r') && text_.substr(end, 2) != "\r\n") line_end_ = "\r";
  std::string_view line;
  take_line(line);
  while (take_line(line)) {
    if (line == "end_header") {
      if (!has_format_) return bad("no format was given");
      header_.data_begin = at_;
      header_.line_count = line_number_;
      return std::move(header_);
    }
    if (auto ok = statement(line); !ok) return tl::unexpected(ok.error());
  }
  return bad("there is no end_header");
}

// Checks that the data can hold all values. In binary files, a value takes its type's size. In text
// files, a value takes at least one digit and one separator.
Expected<void> check_size(const PlyHeader& header, std::size_t bytes_left) {
  for (const PlyElement& element : header.elements) {
    std::uint64_t bytes = 0;
    for (const PlyProperty& p : element.properties) {
      const bool ascii = header.format == PlyFormat::kAscii;
      bytes += ascii ? 2 : byte_size(p.is_list ? p.count_type : p.type);
    }
    if (bytes > 0 && element.count > (bytes_left + 1) / bytes) {
      return bad_input("the PLY header claims " + std::to_string(element.count) + " of element " +
                       in_quotes(element.name) + ", but only " + counted(bytes_left, "byte") +
                       " are left for it; the file is cut short or damaged, copy it again");
    }
    bytes_left -= std::min<std::uint64_t>(bytes_left, bytes * element.count);
  }
  return {};
}

}  // namespace

std::uint32_t byte_size(PlyType type) {
  constexpr std::array<std::uint32_t, 10> kSizes{1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

Expected<PlyHeader> parse_ply_header(std::span<const std::uint8_t> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  auto header = HeaderParser(text.substr(0, kMostHeaderBytes)).parse();
  if (!header) return header;
  if (auto ok = check_size(*header, bytes.size() - header->data_begin); !ok) {
    return tl::unexpected(ok.error());
  }
  return header;
}

}  // namespace vitrine::inline codec
