// SPDX-License-Identifier: Apache-2.0
// The models that the benchmarks of the server publish.
#pragma once

#include <string>

#include "support/product_names.h"
#include "support/tiny_pmesh.h"

namespace vitrine::bench {

struct Scan {
  std::string name;  // such as "skull"
  test::TinyPmesh pmesh;
};

// Returns the model `name` from the folder VITRINE_MODELS, or else from tests/models. Uses
// NAME.pmesh, or builds it from NAME.ply or NAME.obj. Caches the model. Throws if there is no such
// file.
const Scan& scan(const std::string& name);

// A large model, used only in full runs (Effort::is_quick is false).
inline constexpr const char* kLargeScan = "ct-skull-2753k";

}  // namespace vitrine::bench
