// SPDX-License-Identifier: Apache-2.0
#include "recording.h"
#include "support/product_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <stdexcept>

namespace vitrine::test {
namespace {

Said said_in(const nlohmann::json& json) {
  Said said{json.at("sql"), {}};
  for (const auto& value : json.at("values"))
    said.values.push_back(value.is_null() ? std::nullopt : std::optional(value.get<std::string>()));
  return said;
}

// Whether this is the last transaction of the daemon's startup, which releases the migration lock.
bool ends_start(const Transaction& transaction) {
  return transaction.front().sql.starts_with("SELECT pg_advisory_unlock(7957706764961114213)");
}

std::string text_of(const PGresult* result) {
  const auto status = PQresultStatus(result);
  if (status != PGRES_TUPLES_OK && status != PGRES_COMMAND_OK)
    return kRefused + std::string(PQresultErrorMessage(result));
  std::string text = PQcmdStatus(const_cast<PGresult*>(result));
  for (int row = 0; row < PQntuples(result); ++row) {
    text += '\n';
    for (int column = 0; column < PQnfields(result); ++column) {
      text += PQgetisnull(result, row, column) == 1 ? "null" : PQgetvalue(result, row, column);
      text += '|';
    }
  }
  return text;
}

// Returns the PostgreSQL type of each value. The type 0 makes the server derive the type from the
// statement. The server cannot derive the type of a value that the statement does not use. Such
// values are sent as text.
std::vector<Oid> types_of(const Said& said) {
  constexpr Oid kText = 25;
  std::vector<Oid> types;
  for (std::size_t i = 1; i <= said.values.size(); ++i) {
    const std::regex used(fmt::format("\\${}(?!\\d)", i));
    types.push_back(std::regex_search(said.sql, used) ? 0 : kText);
  }
  return types;
}

}  // namespace

Recording read_recording(const std::string& version) {
  std::ifstream file(fmt::format("{}/tests/deploy/upgrade/{}.json", VITRINE_SOURCE_DIR, version));
  Recording recording;
  for (const auto& transaction : nlohmann::json::parse(file)) {
    Transaction next;
    std::ranges::transform(transaction, std::back_inserter(next), said_in);
    const bool is_start =
        recording.start.empty() || (recording.work.empty() && !ends_start(recording.start.back()));
    (is_start ? recording.start : recording.work).push_back(std::move(next));
  }
  return recording;
}

OldDaemon::OldDaemon(const std::string& database) : connection_(PQconnectdb(database.c_str())) {
  if (PQstatus(connection_.get()) != CONNECTION_OK)
    throw std::runtime_error(PQerrorMessage(connection_.get()));
}

std::string OldDaemon::say(const Said& said) const {
  std::vector<const char*> values;
  for (const auto& value : said.values)
    values.push_back(value ? value->c_str() : nullptr);
  const std::vector<Oid> types = types_of(said);
  // PQexecParams() accepts only one statement. Calls without values may contain several, such as
  // those that create the tables.
  PGresult* const result =
      values.empty()
          ? PQexec(connection_.get(), said.sql.c_str())
          : PQexecParams(connection_.get(), said.sql.c_str(), static_cast<int>(values.size()),
                         types.data(), values.data(), nullptr, nullptr, 0);
  std::string text = text_of(result);
  PQclear(result);
  return text;
}

std::vector<std::string> OldDaemon::say(std::span<const Transaction> transactions) const {
  std::vector<std::string> answers;
  for (const Transaction& transaction : transactions) {
    for (const Said& said : transaction)
      answers.push_back(said.sql + "\n" + say(said));
  }
  return answers;
}

}  // namespace vitrine::test
