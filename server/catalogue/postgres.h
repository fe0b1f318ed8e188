// SPDX-License-Identifier: Apache-2.0
// A connection to PostgreSQL, and its prepared statements. Calls time out unless stated otherwise.
#pragma once

#include <libpq-fe.h>

#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/catalogue/sql.h"

namespace vitrine::server::postgres {

struct ClearResult {
  void operator()(PGresult* result) const { PQclear(result); }
};
using QueryResult = std::unique_ptr<PGresult, ClearResult>;

class PostgresConnection final : public sql::DatabaseConnection {
 public:
  // Connects to the server. `url` has libpq's form: postgresql://USER@HOST/DATABASE. Throws if the
  // server is unreachable.
  explicit PostgresConnection(const std::string& url);

  // Returns false if the connection is known to be closed or unusable. Sends nothing to the server.
  bool is_alive();
  bool hangs() const { return hangs_; }

  void run(const char* sql) override;
  sql::Statement& prepare(const std::string& sql) override;
  void begin() override { run("BEGIN"); }
  void roll_back() noexcept override;
  std::uint64_t revision() override;
  const char* text_condition() const override {
    return "words @@ to_tsquery('simple', without_marks(?))";
  }
  std::string text_query(std::span<const std::string> words) const override;
  const char* by_bytes() const override { return " COLLATE \"C\""; }
  const char* now() const override {
    return "CAST(extract(epoch FROM statement_timestamp()) * 1000 AS BIGINT)";
  }
  const char* skip_locked() const override { return "FOR UPDATE SKIP LOCKED"; }

  // Acquires the advisory lock `number`. Waits without a timeout while another session holds the
  // lock.
  void lock(std::int64_t number);
  void unlock(std::int64_t number);

  // Receives the results of a query and returns the last result. `was_sent` is the value that the
  // PQsend…() function returned. Throws if the result is an error.
  QueryResult receive(int was_sent, std::optional<std::chrono::seconds> timeout);
  PGconn* handle() const { return handle_.get(); }

 private:
  [[noreturn]] void raise(const PGresult* result) const;
  void wait_for_answer(std::optional<std::chrono::seconds> timeout);

  struct CloseConnection {
    void operator()(PGconn* handle) const { PQfinish(handle); }
  };
  std::unique_ptr<PGconn, CloseConnection> handle_;
  std::map<std::string, std::unique_ptr<sql::Statement>> statements_;
  // Whether a response has timed out. Data received later could belong to the timed-out query, so
  // the connection must not be used again.
  bool hangs_ = false;
};

inline constexpr std::chrono::seconds kResponseTimeout{10};  // longest wait for a response

}  // namespace vitrine::server::postgres
