// SPDX-License-Identifier: Apache-2.0
// What an older release said to its catalogue (record.mjs), said again.
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
  std::vector<Transaction> start;  // makes the tables
  std::vector<Transaction> work;
};

// Of tests/deploy/upgrade/VERSION.json. Throws where there is none.
Recording read_recording(const std::string& version);

// A daemon of that release, on one connection.
class OldDaemon {
 public:
  explicit OldDaemon(const std::string& database);

  // What the server answers, in text: rows, or the fault's code.
  std::string say(const Said& said) const;
  std::vector<std::string> say(std::span<const Transaction> transactions) const;

 private:
  struct Finish {
    void operator()(PGconn* connection) const { PQfinish(connection); }
  };
  std::unique_ptr<PGconn, Finish> connection_;
};

inline constexpr const char* kRefused = "refused: ";  // so begins an answer that is a fault

}  // namespace vitrine::test
