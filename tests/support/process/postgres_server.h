// SPDX-License-Identifier: Apache-2.0
// A real PostgreSQL server. All tests of a process share it.
#pragma once

#include <string>

namespace vitrine::test {

inline constexpr const char* kPostgresPassword = "a-secret";

// Creates an empty database and returns its URL. Throws if the server cannot be started.
std::string new_database();

void stop_postgres();   // returns after the server has ended
void start_postgres();  // returns once the server responds

}  // namespace vitrine::test
