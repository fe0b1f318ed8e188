// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/catalogue/jobs.h"
#include "server/catalogue/sql.h"

namespace vitrine {

// Jobs and scans in a database that has their tables.
std::unique_ptr<JobCatalogue> make_jobs(std::shared_ptr<sql::Database> database);

}  // namespace vitrine
