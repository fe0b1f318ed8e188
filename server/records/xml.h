// SPDX-License-Identifier: Apache-2.0
// Builds XML documents from texts of any content.
#pragma once

#include <cstddef>
#include <pugixml.hpp>
#include <string>
#include <string_view>

namespace vitrine::server {

// Returns `text` without the characters that XML 1.0 forbids ([XML] section 2.2), such as control
// characters, and without bytes that are not UTF-8.
std::string xml_text(std::string_view text);

// Appends an element with this text to `parent`, unless the text is empty.
void add_text(pugi::xml_node parent, const char* name, std::string_view text);

// Appends an element with this text, even if the text is empty, and returns the element.
pugi::xml_node add_element(pugi::xml_node parent, const char* name, std::string_view text);

void add_attribute(pugi::xml_node node, const char* name, std::string_view value);

// Declares a prefix for a namespace: "xmlns:dc" for example.
inline void add_namespace(pugi::xml_node node, const char* name, const char* uri) {
  node.append_attribute(name).set_value(uri);
}

// States where the schema of a namespace is. Declares the prefix xsi.
void add_schema_location(pugi::xml_node node, std::string_view xml_namespace,
                         std::string_view schema);

// Returns the number of bytes of the node as text.
std::size_t bytes_of(pugi::xml_node node);

// Adds an XML declaration to the document, and returns the document as text in UTF-8.
std::string to_text(pugi::xml_document& document);

}  // namespace vitrine::server
