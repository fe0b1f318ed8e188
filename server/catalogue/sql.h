// SPDX-License-Identifier: Apache-2.0
// What the catalogue needs of a database, so that it is written once for all of them. Statements
// are in the SQL that SQLite and PostgreSQL share, with ? or ?N for what is bound. Errors are
// thrown inside this room and become an Expected at its door.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "codec/core/expected.h"

namespace vitrine::sql {

struct Failure : std::runtime_error {
  Failure(const std::string& message, ErrorCode kind, const char* next_step)
      : std::runtime_error(message), code(kind), advice(next_step) {}
  ErrorCode code;      // kIo; kLimit where the disk is full; kUnsupported as migrate() says
  const char* advice;  // what to do
};

// What was refused, why, and what to do.
inline Unexpected refused(const std::string& what, const Failure& failure) {
  return fail(failure.code, what + ": " + failure.what() + "; " + failure.advice);
}

// Prepared once, used many times: bind, step until false, reset.
class Statement {
 public:
  virtual ~Statement() = default;

  virtual Statement& reset() = 0;
  virtual Statement& bind(std::int64_t value) = 0;
  virtual Statement& bind_real(double value) = 0;
  virtual Statement& bind_null() = 0;  // what nothing was bound to at the end is null
  virtual Statement& bind(std::string_view text) = 0;
  virtual Statement& bind(std::span<const std::uint8_t> blob) = 0;
  virtual bool step() = 0;  // true: there is a row
  bool any();               // steps to the end; true: there was a row

  virtual std::int64_t integer(int column) const = 0;
  virtual double real(int column) const = 0;
  virtual bool is_null(int column) const = 0;
  virtual std::string text(int column) const = 0;
  virtual void bind_to(Statement& other, int column) const = 0;  // the value, whatever its type is
  template <std::size_t N>
  std::array<std::uint8_t, N> blob(int column) const {
    std::array<std::uint8_t, N> bytes{};
    copy_blob(column, bytes);
    return bytes;
  }

 private:
  virtual void copy_blob(int column, std::span<std::uint8_t> out) const = 0;
};

// A statement in use: free again at the end of its scope.
class Query {
 public:
  explicit Query(Statement& statement) : statement_(&statement) {}
  ~Query() { statement_->reset(); }
  Query(const Query&) = delete;
  Query& operator=(const Query&) = delete;
  Statement* operator->() const { return statement_; }
  Statement& operator*() const { return *statement_; }

 private:
  Statement* const statement_;
};

// Of one thread at a time.
class Connection {
 public:
  virtual ~Connection() = default;

  virtual void run(const char* sql) = 0;  // one or more statements without results
  // Prepared at its first use on this connection, and not in use twice at a time.
  virtual Statement& prepare(const std::string& sql) = 0;
  // Begins what becomes true as a whole.
  virtual void begin() = 0;
  virtual void roll_back() noexcept = 0;
  // As Catalogue::revision().
  virtual std::uint64_t revision() = 0;
  // The LIKE that does not mind upper and lower case.
  virtual const char* like() const = 0;
  // Milliseconds since 1970 by the database's clock.
  virtual const char* now() const = 0;
  // Ends a SELECT whose rows are about to be changed: those that somebody else is about to change
  // are left out.
  virtual const char* skip_locked() const = 0;
};

// Thread-safe.
class Database {
 public:
  virtual ~Database() = default;

  // A connection that nobody else uses until the result is gone.
  virtual std::shared_ptr<Connection> lease() = 0;
};

// Rolls back unless committed.
class Transaction {
 public:
  explicit Transaction(Connection& connection) : connection_(connection) { connection.begin(); }
  ~Transaction() {
    if (!done_) connection_.roll_back();
  }
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit() {
    connection_.run("COMMIT");
    done_ = true;
  }

 private:
  Connection& connection_;
  bool done_ = false;
};

// Runs `action` with a connection of its own; a Failure becomes an error.
template <class T, class Action>
Expected<T> guarded(Database& database, Action action) {
  try {
    const auto connection = database.lease();
    return action(*connection);
  } catch (const Failure& failure) {
    return refused("the catalogue refuses", failure);
  }
}

// The tables of a back end: step i leads from version i to i + 1. Never edit one that has been
// released.
struct Migrations {
  std::span<const char* const> steps;
  // The oldest version whose programs go on with the tables of the newest, so that old and new ones
  // may run side by side. Raise it with a step that does more than add what has a default.
  std::int64_t since;
};

// Brings the tables to the newest version. Those of a newer one stay as they are; fails with
// kUnsupported where that one says that these programs cannot go on with them, or says nothing.
void migrate(Connection& connection, const Migrations& migrations);

}  // namespace vitrine::sql
