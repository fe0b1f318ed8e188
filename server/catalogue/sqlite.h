// SPDX-License-Identifier: Apache-2.0
// SQLite behind a few lines: a connection and its statements.
#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "server/catalogue/sql.h"

namespace vitrine::sqlite {

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

class Statement final : public sql::Statement {
 public:
  Statement(const Database& database, std::string_view sql);

  Statement& reset() override;
  Statement& bind(std::int64_t value) override;
  Statement& bind_real(double value) override;
  Statement& bind_null() override { return ++bound_, *this; }
  Statement& bind(std::string_view text) override;
  Statement& bind(std::span<const std::uint8_t> blob) override;
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

  struct Finalize {
    void operator()(sqlite3_stmt* handle) const { sqlite3_finalize(handle); }
  };
  const Database* database_;
  std::unique_ptr<sqlite3_stmt, Finalize> handle_;
  int bound_ = 0;
};

}  // namespace vitrine::sqlite
