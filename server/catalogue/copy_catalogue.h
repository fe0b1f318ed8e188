// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/catalogue/sql.h"

namespace vitrine {

// Copies all of a catalogue, jobs and scans into another database, in one transaction: nobody sees
// a part of it. What is there under the same ids is written over. kState where there is more than
// that: it would be mixed. Fails with kIo, too, and kLimit where the disk is full.
Expected<void> copy_catalogue(sql::Database& from, sql::Database& to);

}  // namespace vitrine
