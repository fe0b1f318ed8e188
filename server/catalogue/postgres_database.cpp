// SPDX-License-Identifier: Apache-2.0
#include "server/catalogue/postgres_database.h"

#include <thread>

#include "server/catalogue/postgres_catalogue.h"
#include "server/catalogue/postgres_migrations.h"

namespace vitrine::server::postgres {
namespace {

constexpr std::chrono::seconds kPause{1};  // pause after a failed attempt to reach the server
// Time between two messages that the holder of the lock sends to the server, to keep the lock.
constexpr std::chrono::seconds kBeat{3};
constexpr const char* kEndsWhenSilent = "SET idle_session_timeout = '15s'";
// The number of the advisory lock of the catalogue.
constexpr std::int64_t kLock = 8532478916893896302;

}  // namespace

// Waits until fewer than kMostConnections connections are in use. Returns an idle connection, or
// null if the caller must open a new one.
std::unique_ptr<PostgresConnection> PostgresDatabase::take_place() {
  std::unique_lock lock(mutex_);
  const bool is_free =
      freed_.wait_for(lock, kResponseTimeout, [this] { return leased_ < kMostConnections; });
  if (!is_free) {
    throw sql::Failure("all connections to PostgreSQL are in use", ErrorCode::kIo,
                       "try again, and check the load of the PostgreSQL server");
  }
  if (std::chrono::steady_clock::now() < away_until_)
    throw sql::Failure("the PostgreSQL server is unreachable", ErrorCode::kIo,
                       "try again in a moment");
  ++leased_;
  if (idle_.empty()) return nullptr;
  auto connection = std::move(idle_.back());
  idle_.pop_back();
  return connection;
}

void PostgresDatabase::give_back(std::unique_ptr<PostgresConnection> connection) {
  const std::scoped_lock lock(mutex_);
  --leased_;
  if (connection && connection->is_alive()) {
    idle_.push_back(std::move(connection));
  } else if (!connection || connection->hangs()) {
    away_until_ = std::chrono::steady_clock::now() + kPause;
  }
  freed_.notify_one();
}

std::shared_ptr<sql::DatabaseConnection> PostgresDatabase::lease() {
  auto connection = take_place();
  try {
    if (!connection || !connection->is_alive())
      connection = std::make_unique<PostgresConnection>(url_);
  } catch (...) {
    give_back(nullptr);
    throw;
  }
  return {connection.release(), [self = shared_from_this()](PostgresConnection* used) {
            self->give_back(std::unique_ptr<PostgresConnection>(used));
          }};
}

// The database lock (lock()). Sends a message to the server every few seconds. If this process is
// suspended or the network is down, the messages stop. The server then closes the connection and
// gives the lock to the next process.
class PostgresDatabase::Lock final : public ExclusiveLock {
 public:
  Lock(std::shared_ptr<PostgresDatabase> database, std::unique_ptr<PostgresConnection> connection)
      : database_(std::move(database)),
        connection_(std::move(connection)),
        renewal_([this](const std::stop_token& stop) { beat(stop); }) {}
  ~Lock() override {
    renewal_ = {};
    try {
      connection_->unlock(kLock);
      connection_->run("RESET idle_session_timeout");
      database_->locking_ = std::move(connection_);
    } catch (const sql::Failure&) {  // the server releases the lock when the connection ends
    }
    database_->own_turn_.release();
  }

  Expected<void> check() const override {
    const std::scoped_lock one(mutex_);
    try {
      connection_->run("SELECT 1");
      return {};
    } catch (const sql::Failure& failure) {
      return sql::refused("the lock on the catalogue was lost", failure);
    }
  }

 private:
  void beat(const std::stop_token& stop) const {
    std::unique_lock lock(resting_);
    while (!rest_.wait_for(lock, stop, kBeat, [&] { return stop.stop_requested(); }))
      static_cast<void>(check());
  }

  const std::shared_ptr<PostgresDatabase> database_;
  mutable std::mutex mutex_;  // guards connection_
  std::unique_ptr<PostgresConnection> connection_;

  mutable std::mutex resting_;
  mutable std::condition_variable_any rest_;
  std::jthread renewal_;
};

Expected<std::shared_ptr<const ExclusiveLock>> PostgresDatabase::lock() {
  own_turn_.acquire();
  auto connection = std::move(locking_);
  try {
    if (!connection || !connection->is_alive())
      connection = std::make_unique<PostgresConnection>(url_);
    connection->run(kEndsWhenSilent);
    connection->lock(kLock);
    return std::make_shared<Lock>(shared_from_this(), std::move(connection));
  } catch (const sql::Failure& failure) {
    own_turn_.release();
    return sql::refused("cannot lock the catalogue", failure);
  } catch (...) {  // catches std::bad_alloc
    own_turn_.release();
    throw;
  }
}

Expected<OpenDatabase> open_database(const std::string& url) {
  try {
    auto database = std::make_shared<PostgresDatabase>(url);
    migrate(*database->lease());
    return OpenDatabase{database, std::make_shared<PostgresDatabase>(url),
                        [database] { return database->lock(); }};
  } catch (const sql::Failure& failure) {
    return sql::refused("cannot open the catalogue", failure);
  }
}

}  // namespace vitrine::server::postgres
