// SPDX-License-Identifier: Apache-2.0
// Copies a catalogue into another database.
#pragma once

#include "server/catalogue/sql.h"

namespace vitrine::server {

// Copies a whole catalogue, including jobs and scans, into another database. Uses one transaction,
// so that no reader sees a partial copy. Overwrites rows with the same IDs. Fails with kState if
// the destination contains rows that the source does not have, because the copy would mix two
// catalogues. Fails with kIo if a database fails, and with kLimit if the disk is full.
Expected<void> copy_catalogue(sql::Database& from, sql::Database& to);

}  // namespace vitrine::server
