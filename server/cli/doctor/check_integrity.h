// SPDX-License-Identifier: Apache-2.0
// Checks every byte of an installation's objects and its catalogue.
#pragma once

#include "server/cli/doctor/finding.h"
#include "server/store/installation.h"

namespace vitrine::server {

// Reads every object that the catalogue names and checks its SHA-256, and checks the catalogue for
// damage. Returns one finding for each damaged object.
Findings check_integrity(const InstallationPlace& place);

}  // namespace vitrine::server
