// SPDX-License-Identifier: Apache-2.0
// Jobs and scans in an SQL database.
#pragma once

#include "server/catalogue/jobs.h"
#include "server/catalogue/sql.h"

namespace vitrine::server {

// Returns the catalogue of jobs in `database`, whose tables sql::migrate() has migrated.
std::unique_ptr<JobCatalogue> make_jobs(std::shared_ptr<sql::Database> database);

}  // namespace vitrine::server
