// SPDX-License-Identifier: Apache-2.0
// Waits for the programs whose environment names a simulated USB bus.
#pragma once

#include <chrono>
#include <string>

namespace vitrine::acquisition::rig {

// Waits until every other process that was started with `variable` ("NAME=value") in its
// environment has ended, or until `timeout` has passed.
void wait_for_users_of(const std::string& variable, std::chrono::milliseconds timeout);

}  // namespace vitrine::acquisition::rig
