// SPDX-License-Identifier: Apache-2.0
// Vertex attributes: values that a mesh stores per vertex besides the position.
//
// To add an attribute, add these parts:
// - here: a semantic, a column and a member of Row;
// - in codec/format/lattice_attributes.h: a lattice;
// - in codec/coding/attribute_model.h: a predictor.
//
// All other code handles attributes only through the operations below.
#pragma once

#include <algorithm>
#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <type_traits>
#include <utility>
#include <vector>

#include "codec/core/vec.h"

namespace vitrine::inline codec {

enum class Semantic : std::uint8_t { kColour };

inline constexpr std::size_t kSemantics = 1;

// A list with at most one T per semantic, in ascending order of semantics. The list allocates no
// memory on the heap.
template <class T>
class PerSemantic {
 public:
  PerSemantic() = default;
  PerSemantic(std::initializer_list<T> items) {
    for (const T& item : items)
      push_back(item);
  }

  std::size_t size() const {
    if (size_ > kSemantics) __builtin_unreachable();  // lets the compiler unroll loops
    return size_;
  }
  bool empty() const { return size_ == 0; }
  T* begin() { return items_.data(); }
  T* end() { return begin() + size(); }
  const T* begin() const { return items_.data(); }
  const T* end() const { return begin() + size(); }
  T& operator[](std::size_t i) { return items_[i]; }
  const T& operator[](std::size_t i) const { return items_[i]; }

  // `size` must not exceed kSemantics.
  void resize(std::size_t size) { size_ = size; }
  void push_back(T item) { items_[size_++] = std::move(item); }

  bool operator==(const PerSemantic& other) const {
    return std::equal(begin(), end(), other.begin(), other.end());
  }

 private:
  std::array<T, kSemantics> items_{};
  std::size_t size_ = 0;
};

// The attributes of all vertices, one column per semantic. A column is either empty or has one
// value per vertex.
struct VertexAttributes {
  std::vector<Colour> colours;

  // The attributes of one vertex. An attribute whose column is empty has the value T{}.
  struct Row {
    Colour colour{};
    std::strong_ordering operator<=>(const Row&) const = default;
  };
  Row row(std::size_t v) const { return {.colour = colours.empty() ? Colour{} : colours[v]}; }

  // Calls visit(semantic, column) for each column that is not empty.
  template <class Visit>
  void for_each(Visit visit) {
    if (!colours.empty()) visit(Semantic::kColour, colours);
  }
  template <class Visit>
  void for_each(Visit visit) const {
    if (!colours.empty()) visit(Semantic::kColour, colours);
  }

  // Copies the values of vertex `from` to vertex `to`.
  void copy(std::size_t to, std::size_t from) {
    for_each([&](Semantic, auto& column) { column[to] = column[from]; });
  }

  // Appends a vertex that has the values of vertex `v`.
  void duplicate(std::size_t v) {
    for_each([&](Semantic, auto& column) { column.push_back(column[v]); });
  }

  // Keeps the first `vertices` vertices and removes all others.
  void truncate(std::size_t vertices) {
    for_each([&](Semantic, auto& column) {
      column.erase(column.begin() + static_cast<std::ptrdiff_t>(vertices), column.end());
    });
  }

  // Returns the attributes for a new order of vertices. Vertex i of the result has the values of
  // vertex from(i). The result has `vertices` vertices.
  template <class From>
  VertexAttributes gather(std::size_t vertices, From from) const {
    VertexAttributes out = *this;
    out.for_each([&](Semantic, auto& column) {
      auto gathered = std::remove_reference_t<decltype(column)>();
      gathered.reserve(vertices);
      for (std::size_t i = 0; i < vertices; ++i)
        gathered.push_back(column[from(i)]);
      column = std::move(gathered);
    });
    return out;
  }

  bool fit(std::size_t vertices) const {
    bool all = true;
    for_each([&](Semantic, const auto& column) { all &= column.size() == vertices; });
    return all;
  }

  PerSemantic<Semantic> semantics() const {
    PerSemantic<Semantic> out;
    for_each([&](Semantic semantic, const auto&) { out.push_back(semantic); });
    return out;
  }
};

}  // namespace vitrine::inline codec
