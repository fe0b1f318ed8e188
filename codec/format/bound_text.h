// SPDX-License-Identifier: Apache-2.0
// Formats error bounds for people.
#pragma once

#include <string>

namespace vitrine::inline codec {

// Formats an error bound with five digits, rounded up, so that `decode --error` accepts the printed
// value.
std::string bound_text(double bound);

}  // namespace vitrine::inline codec
