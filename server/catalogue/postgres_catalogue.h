// SPDX-License-Identifier: Apache-2.0
// The catalogue in a PostgreSQL database, which any number of machines may use at once.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "server/catalogue/exclusive_lock.h"
#include "server/catalogue/sql.h"

namespace vitrine::server::postgres {

struct OpenDatabase {
  std::shared_ptr<sql::Database> database;
  std::shared_ptr<sql::Database> separate;  // the same database, through other connections
  // Acquires a lock that has at most one holder at a time among all processes that use the
  // database. The lock is lost when its connection ends. The server closes this connection if it
  // receives no message for 15 seconds. Fails with kIo.
  std::function<Expected<std::shared_ptr<const ExclusiveLock>>()> lock;
};

// Opens a database, and creates or migrates its tables. `url`: postgresql://USER@HOST/DATABASE,
// with any connection parameter of libpq. Fails with kIo if the server is unreachable or refuses
// the connection. Fails with kUnsupported if a newer version of Vitrine has changed the tables and
// this version cannot use them. Error messages do not contain the password.
Expected<OpenDatabase> open_database(const std::string& url);

}  // namespace vitrine::server::postgres
