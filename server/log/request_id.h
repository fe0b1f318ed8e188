// SPDX-License-Identifier: Apache-2.0
// A name for one request, shown to the client and in the log: 16 hexadecimal digits.
#pragma once

#include <string>

namespace vitrine {

// Unique within a process, and across processes but for a chance of 2^-32. Thread-safe.
std::string next_request_id();

}  // namespace vitrine
