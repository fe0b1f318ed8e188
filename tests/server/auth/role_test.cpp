// SPDX-License-Identifier: Apache-2.0
#include "server/auth/role.h"

#include <gtest/gtest.h>

namespace vitrine::server {
namespace {

TEST(Role, EachIncludesTheOneBefore) {
  EXPECT_LT(Role::kNone, Role::kViewer);
  EXPECT_LT(Role::kViewer, Role::kOperator);
  EXPECT_LT(Role::kOperator, Role::kAdmin);
}

TEST(Role, HasAName) {
  EXPECT_EQ(parse_role("viewer"), Role::kViewer);
  EXPECT_EQ(parse_role("operator"), Role::kOperator);
  EXPECT_EQ(parse_role("admin"), Role::kAdmin);
  EXPECT_EQ(name_of(Role::kAdmin), "admin");
  EXPECT_EQ(name_of(Role::kNone), "none");
  for (const char* name : {"", "none", "Admin", "root", "admin "})
    EXPECT_FALSE(parse_role(name)) << name;
}

}  // namespace
}  // namespace vitrine::server
