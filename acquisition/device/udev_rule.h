// SPDX-License-Identifier: Apache-2.0
// Who may use a board, as deploy/60-vitrine.rules has it.
#pragma once

#include <cstdint>
#include <string>

namespace vitrine {

// Whether the file has a line for boards with these numbers.
bool has_udev_rule(std::uint16_t vendor, std::uint16_t product);

// The line that it would need.
std::string udev_rule(std::uint16_t vendor, std::uint16_t product);

}  // namespace vitrine
