// SPDX-License-Identifier: Apache-2.0
#include "server/auth/role.h"

namespace vitrine::server {

std::optional<Role> parse_role(std::string_view name) noexcept {
  for (const Role role : {Role::kViewer, Role::kOperator, Role::kAdmin}) {
    if (name_of(role) == name) return role;
  }
  return std::nullopt;
}

std::string_view name_of(Role role) noexcept {
  if (role == Role::kNone) return "none";
  return kRoleNames[static_cast<std::size_t>(role) - 1];
}

}  // namespace vitrine::server
