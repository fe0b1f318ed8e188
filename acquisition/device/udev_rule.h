// SPDX-License-Identifier: Apache-2.0
// The udev rule that lets users open a board, as in deploy/60-vitrine.rules.
#pragma once

#include <cstdint>
#include <string>

namespace vitrine::acquisition {

// Returns whether the udev rules file has a line for boards with this vendor and product number.
bool has_udev_rule(std::uint16_t vendor, std::uint16_t product);

// Returns the line that the udev rules file would need for such boards.
std::string udev_rule(std::uint16_t vendor, std::uint16_t product);

}  // namespace vitrine::acquisition
