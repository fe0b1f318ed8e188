// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <utility>

#include "server/catalogue/migrations.h"
#include "server/catalogue/sqlite.h"

namespace vitrine::sqlite {

// What a catalogue is made on: a connection that threads use one at a time, and at whose door a
// Failure becomes an error.
class GuardedConnection {
 protected:
  explicit GuardedConnection(Database database) : database_(std::move(database)) {}

  // Runs `action` alone on the connection.
  template <class T, class Action>
  Expected<T> guarded(Action action) {
    const std::scoped_lock lock(mutex_);
    try {
      return action();
    } catch (const Failure& failure) {
      return refused("the catalogue refuses", failure);
    }
  }

  Database database_;

 private:
  std::mutex mutex_;
};

}  // namespace vitrine::sqlite
