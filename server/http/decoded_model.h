// SPDX-License-Identifier: Apache-2.0
// A published model as a mesh, at a level of detail.
#pragma once

#include "codec/mesh/triangle_mesh.h"
#include "codec/progressive/planner.h"
#include "server/store/published_model.h"

namespace vitrine {

// The surface that visitors see: display filter applied, model units. Our own published file is
// decoded in this process: it was checked when it was published.
Expected<TriangleMesh> decoded_model(const PublishedModel& model, const Want& want);

}  // namespace vitrine
