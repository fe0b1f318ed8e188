// SPDX-License-Identifier: Apache-2.0
// The callback by which long operations report their progress.
#pragma once

#include <functional>
#include <string_view>

namespace vitrine::inline codec {

// Callback for the progress of a long operation, called repeatedly on the working thread. Receives
// the current stage, such as "read" or "encode", and the completed fraction of the whole operation,
// from 0 to 1.
using ProgressReport = std::function<void(std::string_view stage, double fraction)>;

}  // namespace vitrine::inline codec
