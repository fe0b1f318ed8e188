// SPDX-License-Identifier: Apache-2.0
// write(2) that leaves no line half written.
#pragma once

#include <string_view>

namespace vitrine {

// In as many write(2) as it takes. A log that cannot be written must not stop the service: then the
// rest is lost.
void write_whole(int descriptor, std::string_view text);

}  // namespace vitrine
