// SPDX-License-Identifier: Apache-2.0
// The counts of visits in an SQL database.
#pragma once

#include "server/catalogue/sql.h"
#include "server/catalogue/visits.h"

namespace vitrine::server {

// Returns the counts of visits in `database`, whose tables sql::migrate() has migrated.
std::unique_ptr<VisitCatalogue> make_visits(std::shared_ptr<sql::Database> database);

}  // namespace vitrine::server
