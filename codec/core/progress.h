// SPDX-License-Identifier: Apache-2.0
// The callback by which long operations report their progress.
#pragma once

#include <functional>
#include <string_view>

namespace vitrine::inline codec {

// Called repeatedly during a long operation, on the thread that does the work. Receives the name of
// the current stage, such as "read" or "encode", and the completed fraction of the whole operation,
// from 0 to 1.
using ProgressReport = std::function<void(std::string_view stage, double fraction)>;

}  // namespace vitrine::inline codec
