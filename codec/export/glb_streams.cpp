// SPDX-License-Identifier: Apache-2.0
#include "codec/export/glb_streams.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "codec/core/srgb.h"
#include "codec/export/file_writer.h"

namespace vitrine::inline codec {
namespace {

template <class T, std::size_t size>
using Element = std::array<T, size>;

std::uint16_t linear_in_16_bits(std::uint8_t part) {
  return static_cast<std::uint16_t>(srgb_to_linear(part / 255.0) * 65535 + 0.5);
}

std::uint8_t linear_in_8_bits(std::uint8_t part) {
  return static_cast<std::uint8_t>(srgb_to_linear(part / 255.0) * 255 + 0.5);
}

// Whether 8 bits of linear light suffice to restore each sRGB byte of the colours.
bool fit_in_8_bits(std::span<const Colour> colours) {
  std::array<bool, 256> is_used{};
  for (const Colour& colour : colours) {
    for (const std::uint8_t part : colour)
      is_used[part] = true;
  }
  for (std::size_t part = 0; part < is_used.size(); ++part) {
    const double linear = linear_in_8_bits(static_cast<std::uint8_t>(part)) / 255.0;
    const auto restored = static_cast<std::size_t>(linear_to_srgb(linear) * 255 + 0.5);
    if (is_used[part] && restored != part) return false;
  }
  return true;
}

template <class ElementOf>
GlbStream stream(std::string_view semantic, ComponentType component, std::uint32_t components,
                 std::size_t count, const ElementOf& element_of) {
  using One = decltype(element_of(std::size_t{0}));
  FileWriter bytes(count * sizeof(One));
  for (std::size_t v = 0; v < count; ++v)
    bytes.put(element_of(v));
  return {.semantic = semantic,
          .component = component,
          .components = components,
          .count = count,
          .stride = sizeof(One),
          .bytes = bytes.take()};
}

Element<float, 3> floats_of(const Vec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

template <class T>
Bounds bounds_of_elements(const GlbStream& positions) {
  Bounds box;
  for (std::size_t v = 0; v < positions.count; ++v) {
    std::array<T, 3> p;
    std::memcpy(p.data(), positions.bytes.data() + v * positions.stride, sizeof p);
    const Vec3 point{static_cast<double>(p[0]), static_cast<double>(p[1]),
                     static_cast<double>(p[2])};
    if (v == 0) box = {point, point};
    box = bounds_of(std::array{box.low, box.high, point});
  }
  return box;
}

GlbStream exact_positions(const GlbSource& source) {
  GlbStream out = stream("POSITION", ComponentType::kFloat, 3, source.vertices.original.size(),
                         [&](std::size_t v) {
                           const std::uint32_t old = source.vertices.original[v];
                           return floats_of(source.mesh.positions[old] - source.place);
                         });
  out.bounds = bounds_of_elements<float>(out);
  return out;
}

GlbStream colours(const GlbSource& source) {
  const auto& all = source.mesh.attributes.colours;
  const std::size_t count = source.vertices.original.size();
  const auto colour = [&](std::size_t v) { return all[source.vertices.original[v]]; };
  const bool is_short = !fit_in_8_bits(all);
  GlbStream out =
      is_short
          ? stream("COLOR_0", ComponentType::kUnsignedShort, 4, count,
                   [&](std::size_t v) {
                     const auto [r, g, b] = colour(v);
                     return Element<std::uint16_t, 4>{linear_in_16_bits(r), linear_in_16_bits(g),
                                                      linear_in_16_bits(b), 65535};
                   })
          : stream("COLOR_0", ComponentType::kUnsignedByte, 4, count, [&](std::size_t v) {
              const auto [r, g, b] = colour(v);
              return Element<std::uint8_t, 4>{linear_in_8_bits(r), linear_in_8_bits(g),
                                              linear_in_8_bits(b), 255};
            });
  out.is_normalised = true;
  return out;
}

constexpr std::string_view kCoordinateNames[kCoordinateSets] = {"TEXCOORD_0", "TEXCOORD_1"};

bool fit_unit_square(const std::vector<TextureCoordinates>& set) {
  return std::ranges::all_of(set, [](const TextureCoordinates& at) {
    return at[0] >= 0 && at[0] <= 1 && at[1] >= 0 && at[1] <= 1;
  });
}

GlbStream coordinates(const GlbSource& source, std::size_t set, bool may_round) {
  const auto& all = source.vertices.coordinates[set];
  if (!may_round || !fit_unit_square(all)) {
    return stream(kCoordinateNames[set], ComponentType::kFloat, 2, all.size(),
                  [&](std::size_t v) { return all[v]; });
  }
  const auto rounded = [](float part) {
    return static_cast<std::uint16_t>(std::lround(part * 65535.0));
  };
  GlbStream out = stream(kCoordinateNames[set], ComponentType::kUnsignedShort, 2, all.size(),
                         [&](std::size_t v) {
                           return Element<std::uint16_t, 2>{rounded(all[v][0]), rounded(all[v][1])};
                         });
  out.is_normalised = true;
  return out;
}

void add_colours_or_coordinates(const GlbSource& source, bool may_round,
                                std::vector<GlbStream>& out) {
  if (!source.is_textured && !source.mesh.attributes.colours.empty())
    out.push_back(colours(source));
  if (!source.is_textured) return;
  for (std::size_t set = 0; set < kCoordinateSets; ++set) {
    if (!source.vertices.coordinates[set].empty())
      out.push_back(coordinates(source, set, may_round));
  }
}

// Returns the positions as 16-bit coordinates of the grid.
GlbStream short_positions(const GlbSource& source, const ExportGrid& grid) {
  const auto cell = [&](double distance) {
    return static_cast<std::uint16_t>(std::clamp(std::round(distance / grid.step), 0.0, 65535.0));
  };
  GlbStream out = stream("POSITION", ComponentType::kUnsignedShort, 3,
                         source.vertices.original.size(), [&](std::size_t v) {
                           const Vec3 p =
                               source.mesh.positions[source.vertices.original[v]] - source.place;
                           return Element<std::uint16_t, 4>{cell(p.x), cell(p.y), cell(p.z), 0};
                         });
  out.bounds = bounds_of_elements<std::uint16_t>(out);
  return out;
}

// Rounds floats to multiples of the largest power of two that is at most the grid's step. Stores
// them in the form that the filter EXPONENTIAL decodes: 8 bits of exponent above 24 bits of
// mantissa.
GlbStream power_positions(const GlbSource& source, const ExportGrid& grid) {
  GlbStream out = exact_positions(source);
  const Vec3 &a = out.bounds->low, &b = out.bounds->high;
  const double most = std::max(
      {std::abs(a.x), std::abs(a.y), std::abs(a.z), std::abs(b.x), std::abs(b.y), std::abs(b.z)});
  int exponent = static_cast<int>(std::floor(std::log2(grid.step)));
  while (std::ldexp(most, -exponent) > (1 << 23) - 1)
    ++exponent;
  exponent = std::clamp(exponent, -100, 100);
  std::vector<float> values(out.count * 3);
  std::memcpy(values.data(), out.bytes.data(), out.bytes.size());
  FileWriter packed(out.bytes.size());
  for (float& value : values) {
    const auto mantissa = static_cast<std::int32_t>(std::lround(std::ldexp(value, -exponent)));
    packed.put((static_cast<std::uint32_t>(mantissa) & 0xFF'FFFFu) |
               static_cast<std::uint32_t>(exponent) << 24);
    value = std::ldexp(static_cast<float>(mantissa), exponent);
  }
  std::memcpy(out.bytes.data(), values.data(), out.bytes.size());
  out.bounds = bounds_of_elements<float>(out);
  out.bytes = packed.take();
  out.filter = "EXPONENTIAL";
  return out;
}

}  // namespace

std::vector<GlbStream> exact_streams(const GlbSource& source) {
  std::vector<GlbStream> out;
  out.push_back(exact_positions(source));
  if (!source.normals.empty()) {
    out.push_back(stream(
        "NORMAL", ComponentType::kFloat, 3, source.vertices.original.size(),
        [&](std::size_t v) { return floats_of(source.normals[source.vertices.original[v]]); }));
  }
  add_colours_or_coordinates(source, /*may_round=*/false, out);
  return out;
}

std::vector<GlbStream> packed_streams(const GlbSource& source,
                                      const std::optional<ExportGrid>& grid,
                                      bool has_short_positions) {
  std::vector<GlbStream> out;
  out.push_back(!grid                 ? exact_positions(source)
                : has_short_positions ? short_positions(source, *grid)
                                      : power_positions(source, *grid));
  if (!source.normals.empty()) {
    GlbStream normals = stream(
        "NORMAL", ComponentType::kByte, 3, source.vertices.original.size(), [&](std::size_t v) {
          const auto [x, y, z] = floats_of(source.normals[source.vertices.original[v]]);
          return Element<float, 4>{x, y, z, 0};
        });
    normals.is_normalised = true;
    normals.filter = "OCTAHEDRAL";
    out.push_back(std::move(normals));
  }
  add_colours_or_coordinates(source, /*may_round=*/true, out);
  return out;
}

GlbStream index_stream(const SeamVertices& vertices) {
  // 65,535 is no valid 16-bit index: glTF reserves it for primitive restart.
  const bool is_short = vertices.original.size() <= 65535;
  GlbStream out = is_short
                      ? stream("", ComponentType::kUnsignedShort, 1, vertices.faces.size(),
                               [&](std::size_t f) {
                                 const auto [a, b, c] = vertices.faces[f];
                                 return Element<std::uint16_t, 3>{static_cast<std::uint16_t>(a),
                                                                  static_cast<std::uint16_t>(b),
                                                                  static_cast<std::uint16_t>(c)};
                               })
                      : stream("", ComponentType::kUnsignedInt, 1, vertices.faces.size(),
                               [&](std::size_t f) { return vertices.faces[f]; });
  out.count *= 3;
  out.stride /= 3;
  return out;
}

}  // namespace vitrine::inline codec
