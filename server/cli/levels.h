// SPDX-License-Identifier: Apache-2.0
// Sizes and levels as `build` and `info` print it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "codec/progressive/manifest.h"

namespace vitrine::cli {

nlohmann::json bytes_json(const Manifest& manifest);  // total, base, layers, header
nlohmann::json levels_json(const Manifest& manifest);
std::string levels_text(const Manifest& manifest);

}  // namespace vitrine::cli
