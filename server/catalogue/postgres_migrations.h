// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/catalogue/sql.h"

namespace vitrine::postgres {

// Creates or migrates the tables, one process at a time. Migrations only add, so that an older
// version goes on beside a newer one.
void migrate(sql::Connection& connection);

}  // namespace vitrine::postgres
