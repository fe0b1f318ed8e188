// SPDX-License-Identifier: Apache-2.0
// The interface between the catalogue and an SQL database, so that one implementation of the
// catalogue works with SQLite and PostgreSQL. Statements use only SQL that both databases support,
// with ? or ?N for parameters. The classes here throw Failure, which the catalogue converts to an
// Error.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "codec/core/expected.h"

namespace vitrine::server::sql {

struct Failure : std::runtime_error {
  Failure(const std::string& message, ErrorCode kind, const char* next_step)
      : std::runtime_error(message), code(kind), advice(next_step) {}
  ErrorCode code;      // kIo, or kLimit if the disk is full, or kUnsupported as in migrate()
  const char* advice;  // the next step for the operator
};

// Returns an error that states the action that failed, the cause and the next step.
inline Unexpected refused(const std::string& what, const Failure& failure) {
  return fail(failure.code, what + ": " + failure.what() + "; " + failure.advice);
}

// The next step if a catalogue is damaged.
inline constexpr const char* kRestore =
    "run 'vitrine doctor --scrub', or restore a backup with 'vitrine restore'";

// Converts `value` to an enumeration with the values 0 to `last`. Throws a Failure for any other
// `value`, because the row is then damaged.
template <class Enumeration>
Enumeration checked(std::int64_t value, Enumeration last) {
  if (value >= 0 && value <= static_cast<std::int64_t>(last))
    return static_cast<Enumeration>(value);
  throw Failure("a row is damaged: it has an unknown value", ErrorCode::kIo, kRestore);
}

// A prepared statement, which can run many times. For each run: bind the parameters, call step()
// until it returns false, then call reset().
class Statement {
 public:
  virtual ~Statement() = default;

  virtual Statement& reset() = 0;
  virtual Statement& bind(std::int64_t value) = 0;
  virtual Statement& bind_real(double value) = 0;
  virtual Statement& bind_null() = 0;  // parameters that are not bound are null
  virtual Statement& bind(std::string_view text) = 0;
  virtual Statement& bind(std::span<const std::uint8_t> blob) = 0;
  virtual bool step() = 0;  // advances to the next row; returns false if there is none
  bool any();               // runs to the end; returns whether there was a row

  virtual std::int64_t integer(int column) const = 0;
  virtual double real(int column) const = 0;
  virtual bool is_null(int column) const = 0;
  virtual std::string text(int column) const = 0;
  // Binds the value of a column, of any type, as the next parameter of `other`.
  virtual void bind_to(Statement& other, int column) const = 0;
  template <std::size_t N>
  std::array<std::uint8_t, N> blob(int column) const {
    std::array<std::uint8_t, N> bytes{};
    copy_blob(column, bytes);
    return bytes;
  }

 private:
  virtual void copy_blob(int column, std::span<std::uint8_t> out) const = 0;
};

// Converts between unsigned numbers and SQL's integers.
inline std::int64_t number(std::uint64_t value) {
  return static_cast<std::int64_t>(value);
}
inline std::uint64_t count(const Statement& row, int column) {
  return static_cast<std::uint64_t>(row.integer(column));
}

// Resets a statement at the end of its scope, so that it can be used again.
class ScopedStatement {
 public:
  explicit ScopedStatement(Statement& statement) : statement_(&statement) {}
  ~ScopedStatement() { statement_->reset(); }
  ScopedStatement(const ScopedStatement&) = delete;
  ScopedStatement& operator=(const ScopedStatement&) = delete;
  Statement* operator->() const { return statement_; }
  Statement& operator*() const { return *statement_; }

 private:
  Statement* const statement_;
};

// A connection to a database. Only one thread at a time may use it.
class DatabaseConnection {
 public:
  virtual ~DatabaseConnection() = default;

  virtual void run(const char* sql) = 0;  // `sql`: one or more statements
  // Returns the prepared statement for `sql`. Prepares it at the first call on this connection. A
  // statement must not have two users at the same time.
  virtual Statement& prepare(const std::string& sql) = 0;
  virtual void begin() = 0;
  virtual void roll_back() noexcept = 0;
  // Returns the number that Catalogue::revision() describes.
  virtual std::uint64_t revision() = 0;
  // Returns a condition for rows of `model_index`: the row's texts contain all words of a text
  // query. The text query is the condition's only parameter.
  virtual const char* text_condition() const = 0;
  // Returns a text query that finds texts in which each of `words` begins a word. `words` must not
  // contain ASCII punctuation.
  virtual std::string text_query(std::span<const std::string> words) const = 0;
  // Returns the clause that, after a text in ORDER BY, makes the database compare texts by bytes.
  virtual const char* by_bytes() const = 0;
  // Returns the SQL expression for the current time in milliseconds since 1970 by the database's
  // clock.
  virtual const char* now() const = 0;
  // Returns the clause at the end of a SELECT that skips rows locked by another transaction.
  virtual const char* skip_locked() const = 0;
};

// A database that several threads may use at once.
class Database {
 public:
  virtual ~Database() = default;

  // Returns a connection that no other caller uses until the result is destroyed.
  virtual std::shared_ptr<DatabaseConnection> lease() = 0;
};

// A transaction. The destructor rolls it back unless commit() was called.
class Transaction {
 public:
  explicit Transaction(DatabaseConnection& connection) : connection_(connection) {
    connection.begin();
  }
  ~Transaction() {
    if (!is_done_) connection_.roll_back();
  }
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit() {
    connection_.run("COMMIT");
    is_done_ = true;
  }

 private:
  DatabaseConnection& connection_;
  bool is_done_ = false;
};

// Runs `action` with a connection and returns its result. Converts a Failure to an error.
template <class Action>
auto with_connection(Database& database, Action action) -> decltype(action(*database.lease())) {
  try {
    const auto connection = database.lease();
    return action(*connection);
  } catch (const Failure& failure) {
    return refused("cannot use the catalogue", failure);
  }
}

// The schema changes of a database. Step i changes the tables from version i to version i + 1. Do
// not edit a step that has been released.
struct Migrations {
  std::span<const char* const> steps;
  // Programs made for this schema version or a later one can use the newest tables, so their
  // daemons may share the database. Raise this number with each step that does more than add
  // columns with defaults.
  std::int64_t since;
};

// Migrates the tables to the newest version. Leaves tables of a newer version unchanged. In this
// case, fails with kUnsupported unless the database records that this version can use them.
void migrate(DatabaseConnection& connection, const Migrations& migrations);

}  // namespace vitrine::server::sql
