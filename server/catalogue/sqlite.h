// SPDX-License-Identifier: Apache-2.0
// A connection to an SQLite database, and its prepared statements.
#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "server/catalogue/sql.h"

namespace vitrine::server::sqlite {

class SqliteHandle {
 public:
  explicit SqliteHandle(const std::string& file);
  void run(const char* sql);  // `sql`: one or more statements
  sqlite3* handle() const { return handle_.get(); }
  [[noreturn]] void raise() const;  // throws a Failure for the last error

 private:
  struct CloseHandle {
    void operator()(sqlite3* handle) const { sqlite3_close(handle); }
  };
  std::unique_ptr<sqlite3, CloseHandle> handle_;
};

class SqliteStatement final : public sql::Statement {
 public:
  SqliteStatement(const SqliteHandle& database, std::string_view sql);

  SqliteStatement& reset() override;
  SqliteStatement& bind(std::int64_t value) override;
  SqliteStatement& bind_real(double value) override;
  SqliteStatement& bind_null() override { return ++bound_, *this; }
  SqliteStatement& bind(std::string_view text) override;
  SqliteStatement& bind(std::span<const std::uint8_t> blob) override;
  bool step() override;

  std::int64_t integer(int column) const override {
    return sqlite3_column_int64(handle_.get(), column);
  }
  double real(int column) const override { return sqlite3_column_double(handle_.get(), column); }
  bool is_null(int column) const override {
    return sqlite3_column_type(handle_.get(), column) == SQLITE_NULL;
  }
  std::string text(int column) const override;
  void bind_to(sql::Statement& other, int column) const override;

 private:
  void check(int result) const;
  void copy_blob(int column, std::span<std::uint8_t> out) const override;

  struct FinalizeStatement {
    void operator()(sqlite3_stmt* handle) const { sqlite3_finalize(handle); }
  };
  const SqliteHandle* database_;
  std::unique_ptr<sqlite3_stmt, FinalizeStatement> handle_;
  int bound_ = 0;
};

}  // namespace vitrine::server::sqlite
