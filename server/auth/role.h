// SPDX-License-Identifier: Apache-2.0
// The names of roles.
#pragma once

#include <optional>
#include <string_view>

#include "server/catalogue/catalogue.h"

namespace vitrine {

inline constexpr std::string_view kRoleNames[] = {"viewer", "operator", "admin"};

std::optional<Role> parse_role(std::string_view name) noexcept;  // one of kRoleNames
std::string_view name_of(Role role) noexcept;                    // "none" for kNone

}  // namespace vitrine
