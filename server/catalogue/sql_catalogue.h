// SPDX-License-Identifier: Apache-2.0
// The catalogue, its jobs and scans, notes and counts of visits in an SQL database.
#pragma once

#include "server/catalogue/catalogue.h"
#include "server/catalogue/jobs.h"
#include "server/catalogue/notes.h"
#include "server/catalogue/sql.h"
#include "server/catalogue/visits.h"

namespace vitrine::server {

// Each function returns one interface to `database`, whose tables sql::migrate() has migrated.
std::unique_ptr<Catalogue> make_catalogue(std::shared_ptr<sql::Database> database);
std::unique_ptr<JobCatalogue> make_jobs(std::shared_ptr<sql::Database> database);
std::unique_ptr<NoteCatalogue> make_notes(std::shared_ptr<sql::Database> database);
std::unique_ptr<VisitCatalogue> make_visits(std::shared_ptr<sql::Database> database);

// Lists the models by the time of their last change; see Catalogue::harvest(). Throws a Failure.
Harvest harvest_models(sql::DatabaseConnection& connection, const HarvestQuery& query);

}  // namespace vitrine::server
