// SPDX-License-Identifier: Apache-2.0
// A real PostgreSQL server, one for all tests of a process.
#pragma once

#include <string>

namespace vitrine::test {

inline constexpr const char* kPostgresPassword = "a-secret";

// Of a database that is new and empty. Throws where the server cannot be started.
std::string new_database();

void stop_postgres();   // returns once it is gone
void start_postgres();  // … once it answers

}  // namespace vitrine::test
