// SPDX-License-Identifier: Apache-2.0
// Searches the models of an SQL database by words and facets.
#pragma once

#include "server/catalogue/catalogue.h"
#include "server/catalogue/sql.h"

namespace vitrine::server {

// See Catalogue::search() and Catalogue::facets(). All functions throw a Failure.
ModelPage search_models(sql::DatabaseConnection& connection, const ModelQuery& query);
Facets count_facets(sql::DatabaseConnection& connection, const ModelQuery& query);

// See Catalogue::collections().
std::vector<std::string> list_collections(sql::DatabaseConnection& connection);

}  // namespace vitrine::server
