// SPDX-License-Identifier: Apache-2.0
// Whether the paths of a configuration can be used, asked without serving.
#pragma once

#include "codec/core/expected.h"
#include "server/config/settings.h"

namespace vitrine {

// Looks at the data folder, or where it would be made, and at the files that are to be written.
// Creates nothing. Fails (kIo) with the key and the path.
Expected<void> check_paths(const Settings& settings);

}  // namespace vitrine
