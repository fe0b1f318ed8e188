// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/catalogue/catalogue.h"
#include "server/catalogue/sql.h"

namespace vitrine {

// The catalogue in a database that has its tables.
std::unique_ptr<Catalogue> make_catalogue(std::shared_ptr<sql::Database> database);

}  // namespace vitrine
