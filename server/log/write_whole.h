// SPDX-License-Identifier: Apache-2.0
// Writes a log line completely.
#pragma once

#include <string_view>

namespace vitrine::server {

// Calls write(2) until all of `text` is written. If an error occurs, drops the rest of the text,
// because a full disk must not stop the service.
void write_whole(int descriptor, std::string_view text);

}  // namespace vitrine::server
