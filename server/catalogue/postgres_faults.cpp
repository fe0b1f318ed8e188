// SPDX-License-Identifier: Apache-2.0
#include "server/catalogue/find_faults.h"

#include <fmt/core.h>

#include "server/catalogue/postgres.h"

namespace vitrine::server::postgres {
namespace {

constexpr const char* kTables[] = {"model", "chunk",   "job",      "scan",  "idempotency",
                                   "token", "scanner", "revision", "visit", "annotation"};

struct Reference {
  const char *table, *column, *target;
};
constexpr Reference kReferences[] = {{"chunk", "model", "model"},
                                     {"visit", "model", "model"},
                                     {"annotation", "model", "model"},
                                     {"scan", "job", "job"},
                                     {"idempotency", "job", "job"}};

// Returns a row if this user may call the functions of the extension amcheck.
constexpr const char* kHasAmcheck =
    "SELECT 1 WHERE has_function_privilege(to_regprocedure('bt_index_check(regclass)'), 'EXECUTE')";
constexpr const char* kCheckIndices =
    "SELECT 'checked' FROM pg_index i JOIN pg_class c ON c.oid = i.indexrelid "
    "JOIN pg_am a ON a.oid = c.relam JOIN pg_class t ON t.oid = i.indrelid "
    "CROSS JOIN LATERAL bt_index_check(i.indexrelid) checked "
    "WHERE a.amname = 'btree' AND t.relnamespace = current_schema()::regnamespace "
    "AND t.relname IN ('model', 'chunk', 'job', 'scan', 'idempotency', 'token', 'scanner', "
    "'visit', 'annotation') "
    "HAVING count(*) < 0";

class FaultFinder {
 public:
  explicit FaultFinder(const std::string& url) : connection_(url) {
    connection_.run("SET statement_timeout = 0");
  }

  std::vector<std::string> run() {
    for (const char* table : kTables)
      read_all(table);
    for (const Reference& reference : kReferences)
      check(reference);
    if (PQntuples(ask(kHasAmcheck).get()) > 0) expect_none("an index", kCheckIndices);
    return std::move(faults_);
  }

 private:
  // Waits for the result without a timeout, because large tables take long.
  QueryResult ask(const char* sql) {
    return connection_.receive(PQsendQuery(connection_.handle(), sql), std::nullopt);
  }

  // Adds a fault if the query returns a row, or if the server refuses the query because of damage.
  void expect_none(std::string_view what, const std::string& sql) {
    try {
      const auto rows = ask(sql.c_str());
      if (PQntuples(rows.get()) > 0)
        faults_.push_back(fmt::format("{}: {}", what, PQgetvalue(rows.get(), 0, 0)));
    } catch (const sql::Failure& failure) {
      if (!connection_.is_alive()) throw;
      faults_.push_back(fmt::format("{}: {}", what, failure.what()));
    }
  }

  // Converts each row to text, so that the server reads all of its columns.
  void read_all(const char* table) {
    expect_none(fmt::format("the table {}", table),
                fmt::format("SELECT bytes FROM (SELECT sum(length(t::text)) AS bytes FROM {} t) "
                            "whole WHERE bytes < 0",
                            table));
  }

  void check(const Reference& reference) {
    expect_none(fmt::format("the table {}", reference.table),
                fmt::format("SELECT 'a row refers to a row that is missing from {2}' FROM {0} "
                            "LEFT JOIN {2} target ON target.id = {0}.{1} "
                            "WHERE target.id IS NULL LIMIT 1",
                            reference.table, reference.column, reference.target));
  }

  PostgresConnection connection_;
  std::vector<std::string> faults_;
};

}  // namespace

Expected<std::vector<std::string>> find_faults(const std::string& url) {
  try {
    return FaultFinder(url).run();
  } catch (const sql::Failure& failure) {
    return sql::refused("cannot check the catalogue", failure);
  }
}

}  // namespace vitrine::server::postgres
