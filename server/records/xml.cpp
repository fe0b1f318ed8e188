// SPDX-License-Identifier: Apache-2.0
#include "server/records/xml.h"

#include <sstream>

#include "codec/core/printable.h"

namespace vitrine::server {
namespace {

// Whether XML 1.0 allows this well-formed character.
bool is_xml_character(std::string_view character) {
  const auto lead = static_cast<unsigned char>(character[0]);
  if (lead < 0x20) return lead == '\t' || lead == '\n' || lead == '\r';
  return character != "\xEF\xBF\xBE" && character != "\xEF\xBF\xBF";  // U+FFFE and U+FFFF
}

struct ByteCounter final : pugi::xml_writer {
  void write(const void*, std::size_t size) override { bytes += size; }
  std::size_t bytes = 0;
};

}  // namespace

std::string xml_text(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t size = utf8_size(text);
    if (size > 0 && is_xml_character(text.substr(0, size))) out += text.substr(0, size);
    text.remove_prefix(size > 0 ? size : 1);
  }
  return out;
}

void add_text(pugi::xml_node parent, const char* name, std::string_view text) {
  if (!text.empty()) add_element(parent, name, text);
}

pugi::xml_node add_element(pugi::xml_node parent, const char* name, std::string_view text) {
  pugi::xml_node node = parent.append_child(name);
  node.text().set(xml_text(text).c_str());
  return node;
}

void add_attribute(pugi::xml_node node, const char* name, std::string_view value) {
  node.append_attribute(name).set_value(xml_text(value).c_str());
}

void add_schema_location(pugi::xml_node node, std::string_view xml_namespace,
                         std::string_view schema) {
  add_namespace(node, "xmlns:xsi", "http://www.w3.org/2001/XMLSchema-instance");
  add_attribute(node, "xsi:schemaLocation", std::string(xml_namespace) + ' ' + std::string(schema));
}

std::size_t bytes_of(pugi::xml_node node) {
  ByteCounter counter;
  node.print(counter, "", pugi::format_raw, pugi::encoding_utf8);
  return counter.bytes;
}

std::string to_text(pugi::xml_document& document) {
  pugi::xml_node declaration = document.prepend_child(pugi::node_declaration);
  add_attribute(declaration, "version", "1.0");
  add_attribute(declaration, "encoding", "UTF-8");
  std::ostringstream out;
  document.save(out, "", pugi::format_raw, pugi::encoding_utf8);
  return out.str();
}

}  // namespace vitrine::server
