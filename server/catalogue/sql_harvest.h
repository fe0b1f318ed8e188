// SPDX-License-Identifier: Apache-2.0
// Lists the models of an SQL database by the time of their last change.
#pragma once

#include "server/catalogue/catalogue.h"
#include "server/catalogue/sql.h"

namespace vitrine::server {

// See Catalogue::harvest(). Throws a Failure.
Harvest harvest_models(sql::DatabaseConnection& connection, const HarvestQuery& query);

}  // namespace vitrine::server
