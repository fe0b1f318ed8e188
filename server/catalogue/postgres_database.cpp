// SPDX-License-Identifier: Apache-2.0
#include "server/catalogue/postgres_database.h"

#include "server/catalogue/postgres_catalogue.h"
#include "server/catalogue/postgres_migrations.h"

namespace vitrine::postgres {
namespace {

constexpr std::chrono::seconds kPause{1};            // between two attempts to reach the server
constexpr std::int64_t kLock = 8532478916893896302;  // of its own among the database's users

}  // namespace

// An idle connection, or null: then there is a place for a new one.
std::unique_ptr<Connection> Database::take_place() {
  std::unique_lock lock(mutex_);
  const bool is_free =
      freed_.wait_for(lock, kPatience, [this] { return leased_ < kMostConnections; });
  if (!is_free) {
    throw sql::Failure("all connections are in use", ErrorCode::kIo,
                       "try again, and look at the load of the PostgreSQL server");
  }
  if (std::chrono::steady_clock::now() < away_until_)
    throw sql::Failure("the PostgreSQL server is away", ErrorCode::kIo, "try again in a moment");
  ++leased_;
  if (idle_.empty()) return nullptr;
  auto connection = std::move(idle_.back());
  idle_.pop_back();
  return connection;
}

void Database::give_back(std::unique_ptr<Connection> connection) {
  const std::scoped_lock lock(mutex_);
  --leased_;
  if (connection && connection->is_alive()) {
    idle_.push_back(std::move(connection));
  } else if (!connection || connection->hangs()) {
    away_until_ = std::chrono::steady_clock::now() + kPause;
  }
  freed_.notify_one();
}

std::shared_ptr<sql::Connection> Database::lease() {
  auto connection = take_place();
  try {
    if (!connection || !connection->is_alive()) connection = std::make_unique<Connection>(url_);
  } catch (...) {
    give_back(nullptr);
    throw;
  }
  return {connection.release(), [self = shared_from_this()](Connection* used) {
            self->give_back(std::unique_ptr<Connection>(used));
          }};
}

Expected<std::shared_ptr<const void>> Database::lock() {
  own_turn_.acquire();
  try {
    if (!locking_ || !locking_->is_alive()) locking_ = std::make_unique<Connection>(url_);
    locking_->lock(kLock);
  } catch (const sql::Failure& failure) {
    locking_.reset();
    own_turn_.release();
    return sql::refused("the catalogue refuses its lock", failure);
  }
  return std::shared_ptr<const void>(locking_.get(),
                                     [self = shared_from_this()](const void*) { self->unlock(); });
}

void Database::unlock() noexcept {
  try {
    locking_->unlock(kLock);
  } catch (const sql::Failure&) {  // the server unlocks what has lost its connection
    locking_.reset();
  }
  own_turn_.release();
}

Expected<OpenDatabase> open_database(const std::string& url) {
  try {
    auto database = std::make_shared<Database>(url);
    migrate(*database->lease());
    return OpenDatabase{database, [database] { return database->lock(); }};
  } catch (const sql::Failure& failure) {
    return sql::refused("cannot open the catalogue", failure);
  }
}

}  // namespace vitrine::postgres
