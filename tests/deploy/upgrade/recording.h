// SPDX-License-Identifier: Apache-2.0
// Replays the SQL statements that an older release sent to its catalogue. record.mjs records them.
#pragma once

#include <libpq-fe.h>

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace vitrine::test {

struct Said {
  std::string sql;
  std::vector<std::optional<std::string>> values;
};
using Transaction = std::vector<Said>;

struct Recording {
  std::vector<Transaction> start;  // transactions of the daemon's start, which create the tables
  std::vector<Transaction> work;
};

// Reads tests/deploy/upgrade/VERSION.json. Throws if it does not exist.
Recording read_recording(const std::string& version);

// Simulates a daemon of the recorded release. It has one connection to the database.
class OldDaemon {
 public:
  explicit OldDaemon(const std::string& database);

  // Executes a statement. Returns the server's response as text: the command's tag and the rows, or
  // kRefused and the error message.
  std::string say(const Said& said) const;
  std::vector<std::string> say(std::span<const Transaction> transactions) const;

 private:
  struct Finish {
    void operator()(PGconn* connection) const { PQfinish(connection); }
  };
  std::unique_ptr<PGconn, Finish> connection_;
};

inline constexpr const char* kRefused = "refused: ";  // prefix of a response that is an error

}  // namespace vitrine::test
