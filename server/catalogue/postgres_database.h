// SPDX-License-Identifier: Apache-2.0
// The catalogue's database on a PostgreSQL server, with at most kMostConnections connections in
// use. If connecting fails, calls during the next second fail immediately. The first call after
// that second tries to connect again.
#pragma once

#include <condition_variable>
#include <mutex>
#include <semaphore>
#include <vector>

#include "server/catalogue/exclusive_lock.h"
#include "server/catalogue/postgres.h"

namespace vitrine::server::postgres {

class PostgresDatabase final : public sql::Database,
                               public std::enable_shared_from_this<PostgresDatabase> {
 public:
  explicit PostgresDatabase(std::string url) : url_(std::move(url)) {}

  std::shared_ptr<sql::DatabaseConnection> lease() override;

  // Acquires the lock that OpenDatabase::lock describes.
  Expected<std::shared_ptr<const ExclusiveLock>> lock();

 private:
  class Lock;
  static constexpr std::size_t kMostConnections = 8;

  std::unique_ptr<PostgresConnection> take_place();
  void give_back(std::unique_ptr<PostgresConnection> connection);

  const std::string url_;
  std::mutex mutex_;  // guards the members below
  std::condition_variable freed_;
  std::vector<std::unique_ptr<PostgresConnection>> idle_;
  std::size_t leased_ = 0;
  // Until this time, calls fail without an attempt to connect, because a recent attempt failed.
  std::chrono::steady_clock::time_point away_until_{};

  // Ensures that only one thread of this process at a time waits for or holds the database lock
  // (lock()). The lock has a connection of its own, because the thread that holds it needs another
  // connection for queries.
  std::binary_semaphore own_turn_{1};
  // Idle connection for the database lock. Only the thread that has acquired own_turn_ uses it.
  // Null while the database lock is held, or if there is no idle connection.
  std::unique_ptr<PostgresConnection> locking_;
};

}  // namespace vitrine::server::postgres
