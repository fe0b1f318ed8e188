// SPDX-License-Identifier: Apache-2.0
#include "server/catalogue/postgres_database.h"

#include <thread>

#include "server/catalogue/postgres_catalogue.h"
#include "server/catalogue/postgres_migrations.h"

namespace vitrine::postgres {
namespace {

constexpr std::chrono::seconds kPause{1};  // between two attempts to reach the server
constexpr std::chrono::seconds kBeat{3};   // of who holds the lock
constexpr const char* kEndsWhenSilent = "SET idle_session_timeout = '15s'";
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

// The server hears of it every few seconds; where it does not, as the process is stopped or the
// network is cut, it ends the connection and gives the lock to the next.
class Database::Lock final : public ExclusiveLock {
 public:
  Lock(std::shared_ptr<Database> database, std::unique_ptr<Connection> connection)
      : database_(std::move(database)),
        connection_(std::move(connection)),
        heart_([this](const std::stop_token& stop) { beat(stop); }) {}
  ~Lock() override {
    heart_ = {};
    try {
      connection_->unlock(kLock);
      connection_->run("RESET idle_session_timeout");
      database_->locking_ = std::move(connection_);
    } catch (const sql::Failure&) {  // the server unlocks what has lost its connection
    }
    database_->own_turn_.release();
  }

  Expected<void> check() const override {
    const std::scoped_lock one(mutex_);
    try {
      connection_->run("SELECT 1");
      return {};
    } catch (const sql::Failure& failure) {
      return sql::refused("the catalogue's lock is lost", failure);
    }
  }

 private:
  void beat(const std::stop_token& stop) const {
    std::unique_lock lock(resting_);
    while (!rest_.wait_for(lock, stop, kBeat, [&] { return stop.stop_requested(); }))
      static_cast<void>(check());
  }

  const std::shared_ptr<Database> database_;
  mutable std::mutex mutex_;  // guards what follows
  std::unique_ptr<Connection> connection_;

  mutable std::mutex resting_;
  mutable std::condition_variable_any rest_;
  std::jthread heart_;
};

Expected<std::shared_ptr<const ExclusiveLock>> Database::lock() {
  own_turn_.acquire();
  auto connection = std::move(locking_);
  try {
    if (!connection || !connection->is_alive()) connection = std::make_unique<Connection>(url_);
    connection->run(kEndsWhenSilent);
    connection->lock(kLock);
    return std::make_shared<Lock>(shared_from_this(), std::move(connection));
  } catch (const sql::Failure& failure) {
    own_turn_.release();
    return sql::refused("the catalogue refuses its lock", failure);
  } catch (...) {  // out of memory
    own_turn_.release();
    throw;
  }
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
