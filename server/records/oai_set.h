// SPDX-License-Identifier: Apache-2.0
// Names collections as sets of OAI-PMH, whose names have few kinds of characters.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace vitrine::server {

// Returns the setSpec of a collection: its letters A to Z and digits stay; each other byte becomes
// _XX, with its hexadecimal value. Different collections have different setSpecs.
std::string set_spec(std::string_view collection);

// Returns the collection with this setSpec, or nullopt if set_spec() makes no such text.
std::optional<std::string> collection_of(std::string_view spec);

}  // namespace vitrine::server
