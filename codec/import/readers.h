// SPDX-License-Identifier: Apache-2.0
// The readers behind read_mesh(), one file each; all are safe for untrusted bytes.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "codec/core/expected.h"
#include "codec/core/limits.h"
#include "codec/import/companions.h"
#include "codec/import/raw_mesh.h"

namespace vitrine {

Expected<RawMesh> read_ply(std::span<const std::uint8_t> bytes, const Companions& beside);
Expected<RawMesh> read_obj(std::span<const std::uint8_t> bytes, const Companions& beside);
Expected<RawMesh> read_stl(std::span<const std::uint8_t> bytes);
Expected<RawMesh> read_off(std::span<const std::uint8_t> bytes);
Expected<RawMesh> read_glb(std::span<const std::uint8_t> bytes, const Limits& limits);

// How the formats without a magic number are told.
bool is_binary_stl(std::span<const std::uint8_t> bytes);

// Of a binary STL file that ends early, what is there: "3 of 12 triangles". Nothing where the bytes
// do not look like one, or not even its first triangle is there.
std::optional<std::string> facets_of_cut_stl(std::span<const std::uint8_t> bytes);
bool is_off(std::string_view first_word);

}  // namespace vitrine
