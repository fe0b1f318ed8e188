// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "support/tiny_pmesh.h"

namespace vitrine::bench {

struct Scan {
  std::string name;  // "skull"
  test::TinyPmesh pmesh;
};

// Of the folder VITRINE_MODELS, else of tests/models: NAME.pmesh as it is, or NAME.ply or NAME.obj,
// built. Kept for the next section. Throws where there is none.
const Scan& scan(const std::string& name);

// What the figures of adaptation are about.
inline constexpr const char* kLargeScan = "ct-skull-2753k";

}  // namespace vitrine::bench
