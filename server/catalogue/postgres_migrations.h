// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/catalogue/sql.h"

namespace vitrine::postgres {

// Creates or migrates the tables, one process at a time; fails as sql::migrate() does.
void migrate(sql::Connection& connection);

}  // namespace vitrine::postgres
