// SPDX-License-Identifier: Apache-2.0
// Proves that a .pmesh is what it claims to be.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "codec/import/read_mesh.h"
#include "server/jobs/sandbox.h"

namespace vitrine {

// The mesh file that a model was built from, read as it was then.
struct OriginalFile {
  std::span<const std::uint8_t> bytes;
  ReadOptions reading = {};
};

struct Verification {
  std::uint32_t levels = 0;
  std::uint64_t chunks = 0, vertices = 0, faces = 0;
  std::uint32_t orders = 0;      // refinement orders that were tried
  std::optional<bool> lossless;  // nothing where no input was given to compare with
};

// Checks the size and every SHA-256; decodes all levels in order and compares each one's counts and
// boundary loops with the header, its vertices with the boxes of their regions and its error with
// those of its chunks; that each is a manifold with boundary; that random orders which obey the
// region rule pass through manifolds to the same mesh; and, where `input` is given, that the finest
// level equals it: repaired, rounded to the lattice, as a set of faces. Fails (kBadInput) with the
// first fault; a difference from `input` is no fault, but not lossless. Draco decodes the base:
// call it in the sandbox.
Expected<Verification> verify_model(std::span<const std::uint8_t> pmesh,
                                    const std::optional<OriginalFile>& input,
                                    const ProgressReport& progress);

}  // namespace vitrine
