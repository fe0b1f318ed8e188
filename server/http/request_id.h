// SPDX-License-Identifier: Apache-2.0
// Generates request IDs of 16 hexadecimal digits. The client and the log get the same ID.
#pragma once

#include <string>

namespace vitrine::server {

// Returns an ID that is unique within the process. Two processes generate equal IDs with
// probability 2^-32. Thread-safe.
std::string next_request_id();

}  // namespace vitrine::server
