// SPDX-License-Identifier: Apache-2.0
// One self-contained page about a build: pictures of five levels, error against bytes, all figures.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "server/jobs/build_model.h"

namespace vitrine {

// `input` and `reading` are what `built` was built from, `name` is the input's name for people.
// Reads the input once more, so it belongs into the sandbox as the build does. Reports the stage
// "report" alone. Fails where reading or decoding does.
Expected<std::string> build_report(std::string_view name, std::span<const std::uint8_t> input,
                                   const ReadOptions& reading, const BuildResult& built,
                                   const BuildProgress& progress);

}  // namespace vitrine
