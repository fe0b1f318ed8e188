// SPDX-License-Identifier: Apache-2.0
#include "codec/import/dae_document.h"

#include <algorithm>
#include <string>
#include <type_traits>

#include "codec/core/parse_number.h"
#include "codec/import/text_cursor.h"
#include "codec/import/xml_names.h"
#include "codec/repair/raw_mesh.h"

namespace vitrine::inline codec {
namespace {

constexpr std::string_view kXmlBlanks = " \t\r\n";

// Returns the node after `node` in document order within `top`, or an empty node.
DaeNode next_in(const DaeNode& top, DaeNode node) {
  if (node.first_child()) return node.first_child();
  while (node && node != top && !node.next_sibling())
    node = node.parent();
  return node == top ? DaeNode() : node.next_sibling();
}

// Removes the prefix of the root element's namespace from the names of all elements. Few programs
// write one.
void drop_prefixes(const DaeNode& root) {
  if (std::string_view(root.name()).find(':') == std::string_view::npos) return;
  for (DaeNode node = root; node; node = next_in(root, node))
    node.set_name(std::string(local_name(node.name())).c_str());
}

}  // namespace

Expected<DaeDocument> DaeDocument::parse(std::span<const std::uint8_t> bytes) {
  DaeDocument document;
  constexpr unsigned kOptions =
      pugi::parse_minimal | pugi::parse_escapes | pugi::parse_cdata | pugi::parse_trim_pcdata;
  const auto parsed = document.xml_.load_buffer(bytes.data(), bytes.size(), kOptions);
  document.root_ = document.xml_.document_element();
  if (!parsed || local_name(document.root_.name()) != "COLLADA")
    return bad_dae("the XML is damaged");
  drop_prefixes(document.root_);
  document.index();
  return document;
}

void DaeDocument::index() {
  for (DaeNode node = root_; node; node = next_in(root_, node)) {
    ++counts_[node.name()];
    if (const char* id = node.attribute("id").value(); *id != '\0') by_id_.emplace(id, node);
  }
}

DaeNode DaeDocument::find(std::string_view url) const {
  if (url.starts_with('#')) url.remove_prefix(1);
  const auto found = by_id_.find(url);
  return found == by_id_.end() ? DaeNode() : found->second;
}

std::uint64_t DaeDocument::count(std::string_view name) const {
  const auto found = counts_.find(name);
  return found == counts_.end() ? 0 : found->second;
}

std::uint64_t DaeDocument::size_of(const DaeNode& element) {
  const auto length = [](std::string_view text) { return text.size(); };
  std::uint64_t size = 0;
  for (DaeNode node = element; node; node = next_in(element, node)) {
    size += 1 + length(node.name()) + length(node.value());
    for (const pugi::xml_attribute& attribute : node.attributes())
      size += 1 + length(attribute.name()) + length(attribute.value());
  }
  return size;
}

Expected<void> DaeWork::check() const {
  if (done_ > most_)
    return fail(ErrorCode::kLimit,
                "the DAE refers to its elements too often to be read; export the mesh without "
                "instances");
  return {};
}

bool DaeNumbers::is_done() {
  left_.remove_prefix(std::min(left_.find_first_not_of(kXmlBlanks), left_.size()));
  return left_.empty();
}

template <class Number>
std::optional<Number> DaeNumbers::next() {
  if (is_done()) return std::nullopt;
  const std::string_view word = left_.substr(0, left_.find_first_of(kXmlBlanks));
  std::optional<Number> number;
  if constexpr (std::is_same_v<Number, double>)
    number = parse_real(word);
  else
    number = parse_number<Number>(word);
  if (number) left_.remove_prefix(word.size());
  return number;
}
template std::optional<double> DaeNumbers::next<double>();
template std::optional<std::uint32_t> DaeNumbers::next<std::uint32_t>();
template std::optional<std::int64_t> DaeNumbers::next<std::int64_t>();

std::vector<double> numbers_in(const DaeNode& node, std::size_t most) {
  DaeNumbers text(node);
  std::vector<double> numbers;
  while (numbers.size() < most) {
    const auto number = text.next<double>();
    if (!number) break;
    numbers.push_back(*number);
  }
  return numbers;
}

std::uint64_t whole_attribute(const DaeNode& node, const char* name, std::uint64_t otherwise) {
  return parse_number<std::uint64_t>(node.attribute(name).value()).value_or(otherwise);
}

Unexpected bad_dae(std::string fault) {
  return bad_input("the DAE is damaged: " + fault + "; export the file again");
}

}  // namespace vitrine::inline codec
