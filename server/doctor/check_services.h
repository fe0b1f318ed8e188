// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/doctor/finding.h"
#include "server/store/installation.h"

namespace vitrine {

// A bucket and a database: whether they let this machine do what a daemon does, and whether the
// files of all models are there. Writes a small object to the bucket, which is gone afterwards.
Findings check_services(const InstallationPlace& place);

}  // namespace vitrine
