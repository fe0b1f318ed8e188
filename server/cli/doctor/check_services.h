// SPDX-License-Identifier: Apache-2.0
// Checks the object store and the database of an installation.
#pragma once

#include "server/cli/doctor/finding.h"
#include "server/store/installation.h"

namespace vitrine::server {

// Checks that the bucket and the database allow everything a daemon does, and that the files of all
// models exist. Writes a small object to the bucket and removes it again.
Findings check_services(const InstallationPlace& place);

}  // namespace vitrine::server
