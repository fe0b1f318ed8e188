// SPDX-License-Identifier: Apache-2.0
// Converts roles from and to their names.
#pragma once

#include <optional>
#include <string_view>

#include "server/catalogue/catalogue.h"

namespace vitrine::server {

inline constexpr std::string_view kRoleNames[] = {"viewer", "operator", "admin"};

std::optional<Role> parse_role(std::string_view name) noexcept;  // nullopt if not in kRoleNames
std::string_view name_of(Role role) noexcept;                    // returns "none" for kNone

}  // namespace vitrine::server
