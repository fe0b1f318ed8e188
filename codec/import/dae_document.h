// SPDX-License-Identifier: Apache-2.0
// The XML of a COLLADA file [COLLADA]: its elements by their ids, and the numbers in its texts.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <pugixml.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "codec/core/expected.h"

namespace vitrine::inline codec {

using DaeNode = pugi::xml_node;

class DaeDocument {
 public:
  // Parses the file. Fails (kBadInput) if the XML is damaged or has no element COLLADA.
  static Expected<DaeDocument> parse(std::span<const std::uint8_t> bytes);

  DaeNode root() const { return root_; }
  // Returns the element with this id, or an empty node. Ignores a '#' at the start.
  DaeNode find(std::string_view url) const;
  // Returns the number of elements with this name.
  std::uint64_t count(std::string_view name) const;
  // Returns the approximate size in bytes of an element in the file, including all elements inside
  // it.
  static std::uint64_t size_of(const DaeNode& element);

 private:
  void index();

  pugi::xml_document xml_;
  DaeNode root_;
  std::map<std::string_view, DaeNode> by_id_;
  std::map<std::string_view, std::uint64_t> counts_;  // number of elements per name
};

// Bounds the work of a reader that reads an element again for each reference to it.
class DaeWork {
 public:
  explicit DaeWork(std::uint64_t size_of_file) : most_(kMostReadings * size_of_file) {}

  // Counts bytes that are read.
  void add(std::uint64_t bytes) { done_ += bytes; }
  // Fails (kLimit) if the reader has read more than kMostReadings times the size of the file.
  Expected<void> check() const;

 private:
  // A larger value has no use: the limits on vertices and corners already stop a file at about 50
  // copies of a usual geometry.
  static constexpr std::uint64_t kMostReadings = 64;

  std::uint64_t most_, done_ = 0;
};

// Reads numbers separated by blanks.
class DaeNumbers {
 public:
  explicit DaeNumbers(const DaeNode& node) : left_(node.child_value()) {}

  // Returns the next number, or nullopt if the text ends or the next word is not a number.
  template <class Number>
  std::optional<Number> next();
  // Whether all of the text was read.
  bool is_done();

 private:
  std::string_view left_;
};

// Returns all numbers of an element's text up to the first word that is not a number, but at most
// `most` numbers.
std::vector<double> numbers_in(const DaeNode& node, std::size_t most);

// Returns an attribute's value as a whole number, or `otherwise` if the value is not a whole
// number.
std::uint64_t whole_attribute(const DaeNode& node, const char* name, std::uint64_t otherwise);

Unexpected bad_dae(std::string fault);

}  // namespace vitrine::inline codec
