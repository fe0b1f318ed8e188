// SPDX-License-Identifier: Apache-2.0
// Checks the catalogue in a PostgreSQL database for damage.
#pragma once

#include <string>
#include <vector>

#include "codec/core/expected.h"

namespace vitrine::server::postgres {

// Reads every row of the catalogue's tables, so that the server checks its pages. Checks the
// references between the tables. Also checks the indices if the database has the extension amcheck
// and the user may call it. Opens its own connection, so others may use the database at the same
// time. Returns the faults, each in one line; empty if there are none. `url` is as for
// open_database(). Fails with kIo if the server is unreachable.
Expected<std::vector<std::string>> find_faults(const std::string& url);

}  // namespace vitrine::server::postgres
