// SPDX-License-Identifier: Apache-2.0
// The vertex attributes of a hierarchy as integer triples. Edge collapses average these triples and
// vertex splits separate them, as with positions.
//
// Colours are YCoCg-R triples (colour.h).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "codec/format/colour.h"
#include "codec/mesh/vertex_attributes.h"

namespace vitrine::inline codec {

// One attribute for all vertices. `Values` is std::vector<Vec3i> or Segments<Vec3i>.
template <class Values>
struct AttributeColumn {
  Semantic semantic{};
  Values values;
};

template <class Values>
using AttributeColumns = PerSemantic<AttributeColumn<Values>>;

using LatticeAttributes = AttributeColumns<std::vector<Vec3i>>;

// The attributes of one vertex. Value i belongs to column i.
using AttributeTuple = std::array<Vec3i, kSemantics>;

// Returns the attribute value of a merged vertex: the mean of both values, rounded down.
constexpr Vec3i merge_values(const Vec3i& a, const Vec3i& b) {
  return {(a.x + b.x) >> 1, (a.y + b.y) >> 1, (a.z + b.z) >> 1};
}

template <class Values>
PerSemantic<Semantic> semantics_of(const AttributeColumns<Values>& columns) {
  PerSemantic<Semantic> out;
  for (const auto& column : columns)
    out.push_back(column.semantic);
  return out;
}

// Adds an empty column to `to` for each attribute of `from`. `to` must have no columns yet.
template <class Values, class From>
void add_columns(AttributeColumns<Values>& to, const AttributeColumns<From>& from) {
  to.resize(from.size());
  for (std::size_t i = 0; i < from.size(); ++i)
    to[i].semantic = from[i].semantic;
}

// Whether `columns` holds exactly the attributes in `semantics`, each with one value per vertex.
template <class Values>
bool has_all(const AttributeColumns<Values>& columns, const PerSemantic<Semantic>& semantics,
             std::size_t vertices) {
  const auto fits = [&](const AttributeColumn<Values>& column, Semantic semantic) {
    return column.semantic == semantic && column.values.size() == vertices;
  };
  return std::equal(columns.begin(), columns.end(), semantics.begin(), semantics.end(), fits);
}

// Appends the attribute values of vertex `v` from `from` to `to`. Both must have the same
// attributes.
template <class Values, class From>
void append_row(AttributeColumns<Values>& to, const AttributeColumns<From>& from, std::size_t v) {
  for (std::size_t i = 0; i < to.size(); ++i)
    to[i].values.push_back(from[i].values[v]);
}

// Converts attributes to integers without loss: display_attributes() restores the same values.
LatticeAttributes lattice_attributes(const VertexAttributes& attributes);

// Converts the attribute values of vertex `v` in `from` for display and export, and appends them to
// `to`.
template <class Values>
void append_displayed(VertexAttributes& to, const AttributeColumns<Values>& from, std::size_t v) {
  for (const auto& [semantic, values] : from) {
    switch (semantic) {
      case Semantic::kColour:
        to.colours.push_back(from_ycocg(values[v]));
        break;
    }
  }
}

template <class Values>
VertexAttributes display_attributes(const AttributeColumns<Values>& columns) {
  VertexAttributes out;
  const std::size_t vertices = columns.empty() ? 0 : columns[0].values.size();
  for (std::size_t v = 0; v < vertices; ++v)
    append_displayed(out, columns, v);
  return out;
}

}  // namespace vitrine::inline codec
