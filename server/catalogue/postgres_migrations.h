// SPDX-License-Identifier: Apache-2.0
// Brings the tables of a PostgreSQL catalogue to the current version.
#pragma once

#include "server/catalogue/sql.h"

namespace vitrine::server::postgres {

// Creates or migrates the tables. Only one process at a time can migrate them. Fails with the same
// errors as sql::migrate().
void migrate(sql::DatabaseConnection& connection);

}  // namespace vitrine::server::postgres
