// SPDX-License-Identifier: Apache-2.0
// The catalogue's database on a PostgreSQL server: any number of machines may use it at once.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "server/catalogue/exclusive_lock.h"
#include "server/catalogue/sql.h"

namespace vitrine::postgres {

struct OpenDatabase {
  std::shared_ptr<sql::Database> database;
  // Is held by one at a time of all who use the database. Lost where its connection ends: the
  // server ends that of a process that has not been heard of for a quarter of a minute. Fails with
  // kIo.
  std::function<Expected<std::shared_ptr<const ExclusiveLock>>()> lock;
};

// Creates or migrates the tables. `url`: postgresql://USER@HOST/DATABASE, with what else libpq
// knows. Fails with kIo where the server is not reached or refuses, kUnsupported where a newer
// version of the software has tables that this one cannot go on with; no message tells the
// password.
Expected<OpenDatabase> open_database(const std::string& url);

}  // namespace vitrine::postgres
