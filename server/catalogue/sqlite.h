// SPDX-License-Identifier: Apache-2.0
// SQLite behind a few lines: a connection, prepared statements, a transaction. Errors are thrown
// inside this room and become an Expected at its door.
#pragma once

#include <sqlite3.h>

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace vitrine::sqlite {

struct Failure : std::runtime_error {
  Failure(const std::string& message, bool full) : std::runtime_error(message), disk_full(full) {}
  bool disk_full;  // freeing space helps
};

class Database {
 public:
  explicit Database(const std::string& file);
  void run(const char* sql);  // one or more statements without results
  sqlite3* handle() const { return handle_.get(); }
  [[noreturn]] void raise() const;  // says what the operating system said, where it was that

 private:
  struct Close {
    void operator()(sqlite3* handle) const { sqlite3_close(handle); }
  };
  std::unique_ptr<sqlite3, Close> handle_;
};

// Prepared once, used many times: reset, bind, step until false.
class Statement {
 public:
  Statement(const Database& database, std::string_view sql);

  Statement& reset();
  Statement& bind(std::int64_t value);
  Statement& bind_real(double value);
  Statement& bind_null() { return ++bound_, *this; }  // what nothing was bound to is null
  Statement& bind(std::string_view text);
  Statement& bind(std::span<const std::uint8_t> blob);
  bool step();  // true: there is a row
  bool any();   // steps to the end; true: there was a row

  std::int64_t integer(int column) const { return sqlite3_column_int64(handle_.get(), column); }
  double real(int column) const { return sqlite3_column_double(handle_.get(), column); }
  bool is_null(int column) const {
    return sqlite3_column_type(handle_.get(), column) == SQLITE_NULL;
  }
  std::string text(int column) const;
  template <std::size_t N>
  std::array<std::uint8_t, N> blob(int column) const {
    std::array<std::uint8_t, N> bytes{};
    copy_blob(column, bytes);
    return bytes;
  }

 private:
  void check(int result) const;
  void copy_blob(int column, std::span<std::uint8_t> out) const;

  struct Finalize {
    void operator()(sqlite3_stmt* handle) const { sqlite3_finalize(handle); }
  };
  const Database* database_;
  std::unique_ptr<sqlite3_stmt, Finalize> handle_;
  int bound_ = 0;
};

// Takes the write lock at once (BEGIN IMMEDIATE), so that no two writers can deadlock on an
// upgrade; rolls back unless committed.
class Transaction {
 public:
  explicit Transaction(Database& database) : database_(database) {
    database.run("BEGIN IMMEDIATE");
  }
  ~Transaction() {
    if (!done_) sqlite3_exec(database_.handle(), "ROLLBACK", nullptr, nullptr, nullptr);
  }
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit() {
    database_.run("COMMIT");
    done_ = true;
  }

 private:
  Database& database_;
  bool done_ = false;
};

}  // namespace vitrine::sqlite
