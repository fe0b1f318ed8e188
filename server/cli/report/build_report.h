// SPDX-License-Identifier: Apache-2.0
// Makes one self-contained page about a build. It has pictures of five levels, a plot of error
// against bytes, a table of all levels, and facts about the input and the file.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "codec/build/build_model.h"

namespace vitrine::server {

// Makes the page. `input` and `reading` are the arguments of the build, `built` is its result, and
// `name` is the input's name for display. Parses the input again, so it must run in the sandbox.
// Reports its progress as the stage "report". Fails with the errors of reading and decoding.
Expected<std::string> build_report(std::string_view name, std::span<const std::uint8_t> input,
                                   const ReadOptions& reading, const BuildResult& built,
                                   const ProgressReport& progress);

}  // namespace vitrine::server
