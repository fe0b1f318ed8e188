// SPDX-License-Identifier: Apache-2.0
// Parses the command line of vitrine-rig.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "acquisition/rig/fault.h"
#include "acquisition/rig_optics/object_file.h"
#include "acquisition/rig_optics/renderer.h"
#include "acquisition/rig_optics/solid.h"
#include "codec/core/expected.h"

namespace vitrine::acquisition::rig {

struct RigOptions {
  bool shows_help = false, shows_version = false, has_private_network = false;
  std::optional<ObjectFile> object;  // nullopt means an empty table
  Realism realism;
  Finish finish;
  int steps = 720;
  // Speed of the table. If 0, motions complete at once.
  double degrees_per_second = 0;
  std::vector<RigFault> faults;
  std::string address = "127.0.0.1", dialect = "horus", name = "rig";
  // Paths of files. A path is empty if its option is not given.
  std::string write_config, write_truth, write_commands, table;
  std::vector<std::string> command;
};

std::string usage();

// Parses the options. Fails with kBadInput; the error names the option and its valid values.
Expected<RigOptions> parse_options(std::span<const std::string_view> words);

}  // namespace vitrine::acquisition::rig
