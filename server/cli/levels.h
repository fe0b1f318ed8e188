// SPDX-License-Identifier: Apache-2.0
// Lattice, sizes and levels as `build` and `info` print them.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "codec/progressive/manifest.h"

namespace vitrine::cli {

std::string lattice_text(const Manifest& manifest);   // "12 bits, step 0.02 mm"
nlohmann::json bytes_json(const Manifest& manifest);  // total, base, layers, header
nlohmann::json levels_json(const Manifest& manifest);
std::string levels_text(const Manifest& manifest);

// An error bound in five digits, rounded up: `decode --error` accepts what is printed.
std::string bound_text(double bound);

}  // namespace vitrine::cli
