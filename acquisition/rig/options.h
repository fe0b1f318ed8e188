// SPDX-License-Identifier: Apache-2.0
// The command line of vitrine-rig.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "acquisition/rig/fault.h"
#include "acquisition/rig/placed_mesh.h"
#include "acquisition/rig/renderer.h"
#include "acquisition/rig/solid.h"
#include "codec/core/expected.h"

namespace vitrine::rig {

struct RigOptions {
  bool help = false, version = false, private_network = false;
  std::optional<PlacedMesh> object;  // nothing: an empty table, its plate bare
  Realism realism;
  Finish finish;
  int steps = 720;
  double degrees_per_second = 0;  // of the table; 0: it is there at once
  std::vector<Fault> faults;
  std::string address = "127.0.0.1", dialect = "horus", name = "rig";
  std::string write_config, write_truth, write_commands, table;  // files; empty: not asked for
  std::vector<std::string> command;
};

std::string_view usage();

// Fails (kBadInput) with the option and what it takes.
Expected<RigOptions> parse_options(std::span<const std::string_view> words);

}  // namespace vitrine::rig
