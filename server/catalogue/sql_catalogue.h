// SPDX-License-Identifier: Apache-2.0
// The catalogue in an SQL database.
#pragma once

#include "server/catalogue/catalogue.h"
#include "server/catalogue/sql.h"

namespace vitrine::server {

// Returns the catalogue in `database`, whose tables sql::migrate() has migrated.
std::unique_ptr<Catalogue> make_catalogue(std::shared_ptr<sql::Database> database);

}  // namespace vitrine::server
