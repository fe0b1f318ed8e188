// SPDX-License-Identifier: Apache-2.0
// The catalogue's database on a PostgreSQL server, over a bounded number of connections. While the
// server is away all that is asked of it fails, most of it at once; what is asked afterwards has
// new connections.
#pragma once

#include <condition_variable>
#include <mutex>
#include <semaphore>
#include <vector>

#include "server/catalogue/exclusive_lock.h"
#include "server/catalogue/postgres.h"

namespace vitrine::postgres {

class Database final : public sql::Database, public std::enable_shared_from_this<Database> {
 public:
  explicit Database(std::string url) : url_(std::move(url)) {}

  std::shared_ptr<sql::Connection> lease() override;

  // As OpenDatabase::lock.
  Expected<std::shared_ptr<const ExclusiveLock>> lock();

 private:
  class Lock;
  static constexpr std::size_t kMostConnections = 8;

  std::unique_ptr<Connection> take_place();
  void give_back(std::unique_ptr<Connection> connection);

  const std::string url_;
  std::mutex mutex_;  // guards what follows
  std::condition_variable freed_;
  std::vector<std::unique_ptr<Connection>> idle_;
  std::size_t leased_ = 0;
  std::chrono::steady_clock::time_point away_until_{};  // nobody waits for the server before

  // Of its own: who holds the lock needs a connection beside it, and others wait for it meanwhile.
  std::binary_semaphore own_turn_{1};
  std::unique_ptr<Connection> locking_;  // of whose turn it is, where it is good
};

}  // namespace vitrine::postgres
