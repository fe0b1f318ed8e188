// SPDX-License-Identifier: Apache-2.0
// Programs that find a simulated USB bus in their environment.
#pragma once

#include <chrono>
#include <string>

namespace vitrine::rig {

// Waits until no other process has `variable` ("NAME=value") in the environment it was started
// with, for `patience` at most.
void wait_for_users_of(const std::string& variable, std::chrono::milliseconds patience);

}  // namespace vitrine::rig
