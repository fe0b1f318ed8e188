// SPDX-License-Identifier: Apache-2.0
// Parses the address of a listener, as the settings state it.
#pragma once

#include <string_view>

#include "codec/core/expected.h"
#include "server/config/settings.h"

namespace vitrine::server {

// Parses HOST:PORT with a numeric address, or unix:PATH. Fails with kBadInput.
Expected<Endpoint> parse_endpoint(std::string_view text);

}  // namespace vitrine::server
