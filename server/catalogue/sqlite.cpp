// SPDX-License-Identifier: Apache-2.0
#include "server/catalogue/sqlite.h"

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace vitrine::server::sqlite {
namespace {

constexpr int kBusyMilliseconds = 10'000;  // longest wait while another process writes

constexpr const char* kAdvice = "check the data folder";

// Returns the operating system's error number for the last result, or 0. SQLite reports a full disk
// in two ways: with a result code of its own, and as an I/O error if the index of the write-ahead
// log cannot grow.
int system_error(sqlite3* handle) {
  switch (sqlite3_extended_errcode(handle) & 0xff) {
    case SQLITE_FULL:
      return ENOSPC;
    case SQLITE_IOERR:
    case SQLITE_CANTOPEN:
      return sqlite3_system_errno(handle);
    default:
      return 0;
  }
}

// Whether the connection's last error means that the file is damaged. SQLITE_ERROR counts as
// damage, because SQLite returns it if a table or a column is missing.
bool is_damage(sqlite3* handle) {
  const int code = sqlite3_extended_errcode(handle) & 0xff;
  return code == SQLITE_CORRUPT || code == SQLITE_NOTADB || code == SQLITE_ERROR;
}

}  // namespace

SqliteHandle::SqliteHandle(const std::string& file) {
  sqlite3* handle = nullptr;
  const int result =
      sqlite3_open_v2(file.c_str(), &handle,
                      SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX, nullptr);
  handle_.reset(handle);
  if (result != SQLITE_OK) raise();
  sqlite3_extended_result_codes(handle, 1);
  sqlite3_busy_timeout(handle, kBusyMilliseconds);
}

void SqliteHandle::raise() const {
  const int error = system_error(handle());
  std::string message = sqlite3_errmsg(handle());
  if (error != 0) message += std::string(": ") + std::strerror(error);
  if (error == ENOSPC || error == EDQUOT)
    throw sql::Failure(message, ErrorCode::kLimit, "free some space or choose another data folder");
  throw sql::Failure(message, ErrorCode::kIo, is_damage(handle()) ? sql::kRestore : kAdvice);
}

void SqliteHandle::run(const char* sql) {
  if (sqlite3_exec(handle(), sql, nullptr, nullptr, nullptr) != SQLITE_OK) raise();
}

SqliteStatement::SqliteStatement(const SqliteHandle& database, std::string_view sql)
    : database_(&database) {
  sqlite3_stmt* handle = nullptr;
  const int result = sqlite3_prepare_v3(database.handle(), sql.data(), static_cast<int>(sql.size()),
                                        SQLITE_PREPARE_PERSISTENT, &handle, nullptr);
  handle_.reset(handle);
  if (result != SQLITE_OK) database.raise();
}

void SqliteStatement::check(int result) const {
  if (result != SQLITE_OK) database_->raise();
}

SqliteStatement& SqliteStatement::reset() {
  sqlite3_reset(handle_.get());
  sqlite3_clear_bindings(handle_.get());
  bound_ = 0;
  return *this;
}

SqliteStatement& SqliteStatement::bind(std::int64_t value) {
  check(sqlite3_bind_int64(handle_.get(), ++bound_, value));
  return *this;
}

SqliteStatement& SqliteStatement::bind_real(double value) {
  check(sqlite3_bind_double(handle_.get(), ++bound_, value));
  return *this;
}

SqliteStatement& SqliteStatement::bind(std::string_view text) {
  check(sqlite3_bind_text64(handle_.get(), ++bound_, text.data(), text.size(), SQLITE_TRANSIENT,
                            SQLITE_UTF8));
  return *this;
}

SqliteStatement& SqliteStatement::bind(std::span<const std::uint8_t> blob) {
  check(sqlite3_bind_blob64(handle_.get(), ++bound_, blob.data(), blob.size(), SQLITE_TRANSIENT));
  return *this;
}

bool SqliteStatement::step() {
  const int result = sqlite3_step(handle_.get());
  if (result == SQLITE_ROW) return true;
  if (result == SQLITE_DONE) {
    sqlite3_reset(handle_.get());  // ends the read transaction
    return false;
  }
  database_->raise();
}

std::string SqliteStatement::text(int column) const {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(handle_.get(), column));
  return std::string(text, static_cast<std::size_t>(sqlite3_column_bytes(handle_.get(), column)));
}

void SqliteStatement::bind_to(sql::Statement& other, int column) const {
  switch (sqlite3_column_type(handle_.get(), column)) {
    case SQLITE_INTEGER:
      other.bind(integer(column));
      return;
    case SQLITE_FLOAT:
      other.bind_real(real(column));
      return;
    case SQLITE_TEXT:
      other.bind(text(column));
      return;
    case SQLITE_BLOB:
      other.bind(
          std::span(static_cast<const std::uint8_t*>(sqlite3_column_blob(handle_.get(), column)),
                    static_cast<std::size_t>(sqlite3_column_bytes(handle_.get(), column))));
      return;
    default:
      other.bind_null();
  }
}

void SqliteStatement::copy_blob(int column, std::span<std::uint8_t> out) const {
  const auto* bytes = static_cast<const std::uint8_t*>(sqlite3_column_blob(handle_.get(), column));
  if (sqlite3_column_bytes(handle_.get(), column) != static_cast<int>(out.size())) {
    throw sql::Failure("a row is damaged: a column does not have the expected length",
                       ErrorCode::kIo, sql::kRestore);
  }
  std::copy_n(bytes, out.size(), out.begin());
}

}  // namespace vitrine::server::sqlite
