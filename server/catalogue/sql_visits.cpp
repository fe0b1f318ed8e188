// SPDX-License-Identifier: Apache-2.0
#include "server/catalogue/sql_catalogue.h"

namespace vitrine::server {
namespace {

using std::chrono::sys_days;

// Adds to the row if it exists already, because several daemons may share the catalogue.
const std::string kAddVisits =
    "INSERT INTO visit(model, day, visits, seconds, levels, complete) "
    "SELECT id, ?2, ?3, ?4, ?5, ?6 FROM model WHERE id = ?1 "
    "ON CONFLICT (model, day) DO UPDATE SET visits = visit.visits + excluded.visits, "
    "seconds = visit.seconds + excluded.seconds, levels = visit.levels + excluded.levels, "
    "complete = visit.complete + excluded.complete";
// Casts the sums, because PostgreSQL's sum() of BIGINT values is NUMERIC.
const std::string kVisitsByModel =
    "SELECT model.id, title, CAST(sum(visits) AS BIGINT), CAST(sum(seconds) AS BIGINT), "
    "CAST(sum(levels) AS BIGINT), CAST(sum(complete) AS BIGINT) "
    "FROM visit JOIN model ON model.id = visit.model WHERE day BETWEEN ? AND ? "
    "GROUP BY model.id, title ORDER BY 3 DESC, 1 LIMIT ?";
const std::string kVisitsByDay =
    "SELECT model.id, title, visits, seconds, levels, complete, day "
    "FROM visit JOIN model ON model.id = visit.model WHERE day BETWEEN ? AND ? "
    "ORDER BY day, visit.model LIMIT ?";

std::int64_t number_of(sys_days day) {
  return day.time_since_epoch().count();
}

std::uint64_t unsigned_in(const sql::Statement& row, int column) {
  return static_cast<std::uint64_t>(row.integer(column));
}

ModelVisits read_visits(const sql::Statement& row) {
  return {.model = ModelId::from_bytes(row.blob<16>(0)),
          .title = row.text(1),
          .counts = {.visits = unsigned_in(row, 2),
                     .seconds = unsigned_in(row, 3),
                     .levels = unsigned_in(row, 4),
                     .complete = unsigned_in(row, 5)}};
}

DayVisits read_day(const sql::Statement& row) {
  return {.day = sys_days(std::chrono::days(row.integer(6))), .of = read_visits(row)};
}

void add_counts(sql::DatabaseConnection& connection, const ModelDay& to, const VisitCounts& more) {
  const sql::ScopedStatement row(connection.prepare(kAddVisits));
  row->bind(to.model.bytes()).bind(number_of(to.day));
  for (const std::uint64_t count : {more.visits, more.seconds, more.levels, more.complete})
    row->bind(static_cast<std::int64_t>(count));
  row->any();
}

class SqlVisits final : public VisitCatalogue {
 public:
  explicit SqlVisits(std::shared_ptr<sql::Database> database) : database_(std::move(database)) {}

  // Adds the counts in the order of the map. Two daemons that add counts at the same time therefore
  // lock rows in the same order and cannot deadlock.
  Expected<void> add(const VisitsOfDays& more) override {
    const auto run = [&](sql::DatabaseConnection& connection) -> Expected<void> {
      sql::Transaction transaction(connection);
      for (const auto& [to, counts] : more)
        add_counts(connection, to, counts);
      transaction.commit();
      return {};
    };
    return sql::with_connection(*database_, run);
  }

  Expected<std::vector<ModelVisits>> by_model(const DayRange& range, std::uint32_t limit) override {
    return read_all(kVisitsByModel, range, limit, read_visits);
  }

  Expected<std::vector<DayVisits>> by_day(const DayRange& range, std::uint32_t limit) override {
    return read_all(kVisitsByDay, range, limit, read_day);
  }

 private:
  template <class Row>
  Expected<std::vector<Row>> read_all(const std::string& sql, const DayRange& range,
                                      std::uint32_t limit, Row (*read)(const sql::Statement&)) {
    const auto run = [&](sql::DatabaseConnection& connection) -> Expected<std::vector<Row>> {
      std::vector<Row> all;
      const sql::ScopedStatement rows(connection.prepare(sql));
      rows->bind(number_of(range.first)).bind(number_of(range.last)).bind(std::int64_t{limit});
      while (rows->step())
        all.push_back(read(*rows));
      return all;
    };
    return sql::with_connection(*database_, run);
  }

  const std::shared_ptr<sql::Database> database_;
};

}  // namespace

std::unique_ptr<VisitCatalogue> make_visits(std::shared_ptr<sql::Database> database) {
  return std::make_unique<SqlVisits>(std::move(database));
}

}  // namespace vitrine::server
