// SPDX-License-Identifier: Apache-2.0
#include "server/catalogue/sql_catalogue.h"

#include <fmt/core.h>

#include <algorithm>

#include "server/catalogue/sql_model.h"

namespace vitrine::server {
namespace {

using sql::DatabaseConnection;
using sql::ScopedStatement;
using sql::Statement;

// Returns the SQL condition on rows of `model_index` for the query, without the condition for the
// query's cursor.
std::string harvest_condition(const HarvestQuery& query) {
  std::string condition = "state = 1";
  if (query.model) condition += " AND model = ?";
  if (query.from) condition += " AND changed >= ?";
  if (query.until) condition += " AND changed <= ?";
  if (!query.collection.empty()) {
    condition +=
        " AND facets LIKE (SELECT '% ' || id || ' %' FROM facet_value "
        "WHERE name = 'collection' AND value = ?)";
  }
  return condition;
}

void bind_condition(Statement& rows, const HarvestQuery& query) {
  if (query.model) rows.bind(query.model->bytes());
  if (query.from) rows.bind(*query.from);
  if (query.until) rows.bind(*query.until);
  if (!query.collection.empty()) rows.bind(query.collection);
}

std::uint64_t count_harvest(DatabaseConnection& connection, const HarvestQuery& query) {
  const ScopedStatement row(
      connection.prepare("SELECT count(*) FROM model_index WHERE " + harvest_condition(query)));
  bind_condition(*row, query);
  return row->step() ? sql::count(*row, 0) : 0;
}

std::int64_t read_clock(DatabaseConnection& connection) {
  const ScopedStatement row(connection.prepare(fmt::format("SELECT {}", connection.now())));
  return row->step() ? row->integer(0) / 1000 : 0;
}

// Returns the query without `from` if it has a cursor. The cursor then limits the start of the
// period, so that the database finds the first row by both columns of the index model_by_change.
HarvestQuery from_cursor(HarvestQuery query) {
  if (!query.after) return query;
  if (query.from && query.after->changed < *query.from) query.after = {*query.from, ModelId()};
  query.from = std::nullopt;
  return query;
}

}  // namespace

Harvest harvest_models(DatabaseConnection& connection, const HarvestQuery& asked) {
  const HarvestQuery query = from_cursor(asked);
  // The index of the column after those of kModelColumns and kFurtherColumns.
  constexpr int kChanged = 2 + static_cast<int>(std::ranges::count(kModelColumns, ','));
  const std::string found = fmt::format(
      "SELECT model AS of_model, changed FROM model_index WHERE {}{} "
      "ORDER BY changed, model LIMIT ?",
      harvest_condition(query), query.after ? " AND (changed, model) > (?, ?)" : "");
  const ScopedStatement rows(connection.prepare(
      fmt::format("SELECT {}, {}, changed FROM model JOIN ({}) AS found ON id = of_model "
                  "ORDER BY changed, id",
                  kModelColumns, kFurtherColumns, found)));
  bind_condition(*rows, query);
  if (query.after) rows->bind(query.after->changed).bind(query.after->model.bytes());
  rows->bind(std::int64_t{std::clamp(query.limit, 1u, kMaxPage)});
  Harvest harvest;
  harvest.now = read_clock(connection);
  if (!query.after) harvest.all = count_harvest(connection, query);
  while (rows->step())
    harvest.models.push_back({.model = read_model(*rows), .changed = rows->integer(kChanged)});
  return harvest;
}

}  // namespace vitrine::server
