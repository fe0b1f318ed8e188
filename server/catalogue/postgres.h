// SPDX-License-Identifier: Apache-2.0
// PostgreSQL behind a few lines: a connection that never waits for ever, and its statements.
#pragma once

#include <libpq-fe.h>

#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/catalogue/sql.h"

namespace vitrine::postgres {

struct Clear {
  void operator()(PGresult* result) const { PQclear(result); }
};
using Result = std::unique_ptr<PGresult, Clear>;

class Connection final : public sql::Connection {
 public:
  // `url` as libpq has it: postgresql://USER@HOST/DATABASE. Throws where nobody answers.
  explicit Connection(const std::string& url);

  bool is_alive();  // as far as is known without asking
  bool hangs() const { return hangs_; }

  void run(const char* sql) override;
  sql::Statement& prepare(const std::string& sql) override;
  void begin() override { run("BEGIN"); }
  void roll_back() noexcept override;
  std::uint64_t revision() override;
  const char* like() const override { return "ILIKE"; }
  const char* now() const override {
    return "CAST(extract(epoch FROM statement_timestamp()) * 1000 AS BIGINT)";
  }
  const char* skip_locked() const override { return "FOR UPDATE SKIP LOCKED"; }

  // Waits for the lock of that number, however long another session holds it.
  void lock(std::int64_t number);
  void unlock(std::int64_t number);

  // What was sent with a function PQsend…(): its last result. Throws where it is an error.
  Result receive(int was_sent, std::optional<std::chrono::seconds> patience);
  PGconn* handle() const { return handle_.get(); }

 private:
  [[noreturn]] void raise(const PGresult* result) const;
  void wait_for_answer(std::optional<std::chrono::seconds> patience);

  struct Finish {
    void operator()(PGconn* handle) const { PQfinish(handle); }
  };
  std::unique_ptr<PGconn, Finish> handle_;
  std::map<std::string, std::unique_ptr<sql::Statement>> statements_;
  bool hangs_ = false;  // it did not answer in time: what comes yet would be an old answer
};

inline constexpr std::chrono::seconds kPatience{10};  // for an answer

}  // namespace vitrine::postgres
