// SPDX-License-Identifier: Apache-2.0
// Decodes a published model into a mesh at a requested level of detail.
#pragma once

#include "codec/mesh/triangle_mesh.h"
#include "codec/plan/planner.h"
#include "server/store/published_model.h"

namespace vitrine::server {

// Returns the mesh of the model at the level of detail `want`, in model units and with the display
// filter applied. Decodes in this process, without a sandbox, since the file was checked when it
// was published.
Expected<TriangleMesh> decoded_model(const PublishedModel& model, const Want& want);

}  // namespace vitrine::server
