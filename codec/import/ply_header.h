// SPDX-License-Identifier: Apache-2.0
// Parses the header of a PLY file: the encoding, the elements and their properties.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "codec/core/expected.h"

namespace vitrine::inline codec {

enum class PlyFormat { kAscii, kLittleEndian, kBigEndian };
enum class PlyType {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
  kFloat32,
  kFloat64
};

std::uint32_t byte_size(PlyType type);

struct PlyProperty {
  std::string name;  // in lower case
  PlyType type;      // type of the value, or of the values in a list
  bool is_list = false;
  PlyType count_type = PlyType::kUint8;
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::kAscii;
  std::vector<PlyElement> elements;
  std::vector<std::string> textures;  // file names from TextureFile comments
  std::size_t data_begin = 0;         // byte offset of the data after the header
  std::uint64_t line_count = 0;       // lines of the header, including end_header
};

// Parses the header. Fails if the bytes after the header cannot hold all stated elements.
Expected<PlyHeader> parse_ply_header(std::span<const std::uint8_t> bytes);

}  // namespace vitrine::inline codec
