// SPDX-License-Identifier: Apache-2.0
// Formats lattice, sizes and levels for `build` and `info`.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "codec/format/bound_text.h"
#include "codec/format/manifest.h"

namespace vitrine::server::cli {

// Returns a text such as "12 bits, step 0.02 mm".
std::string lattice_text(const Manifest& manifest);
// Returns sizes in bytes: total, base, layers, header, texture (atlas and pictures).
nlohmann::json bytes_json(const Manifest& manifest);
nlohmann::json levels_json(const Manifest& manifest);
std::string levels_text(const Manifest& manifest);

}  // namespace vitrine::server::cli
