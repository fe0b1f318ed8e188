// SPDX-License-Identifier: Apache-2.0
// Runs the work of a command in the sandbox: parsing, decoding and building. The code outside the
// sandbox opens files, writes the output and prints.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>

#include "codec/export/write_mesh.h"
#include "server/cli/support/outcome.h"
#include "server/sandbox/sandbox.h"

namespace vitrine::server::cli {

struct Product {
  nlohmann::json report;           // the results; isolate() prints each line of the member "note"
  std::vector<std::uint8_t> file;  // content of the output file; may be empty
  std::string page = {};           // content of the report page; empty if there is none
  std::vector<MeshFile> companions = {};  // files beside the output file; their names are untrusted
};

// Runs `task` in the sandbox. Error messages begin with `subject`, which names the input.
tl::expected<Product, Fault> isolate(
    const std::string& subject, const std::function<Expected<Product>(const ProgressReport&)>& task,
    const SpillOptions& spill = {});

}  // namespace vitrine::server::cli
