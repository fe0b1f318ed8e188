// SPDX-License-Identifier: Apache-2.0
// Every command parses, decodes and builds inside the sandbox; outside, it opens files, writes the
// output and prints.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>

#include "server/cli/outcome.h"
#include "server/jobs/sandbox.h"

namespace vitrine::cli {

struct Product {
  nlohmann::json report;           // isolate() prints its "note", too, where there is one
  std::vector<std::uint8_t> file;  // the output file's bytes; may be empty
  std::string page = {};           // a page about it; may be empty
};

// `subject` names the input at the start of the error message.
tl::expected<Product, Fault> isolate(
    const std::string& subject, const std::function<Expected<Product>(const ProgressReport&)>& task,
    const SpillOptions& spill = {});

}  // namespace vitrine::cli
