// SPDX-License-Identifier: Apache-2.0
// Derives the claim of a running job, and the ID of the model that the job makes.
#pragma once

#include "server/catalogue/jobs.h"

namespace vitrine::server {

inline JobClaim claim_of(const JobRecord& job) {
  return {.job = job.id, .fence = job.fence};
}

// Returns the ID of the model that a job makes. The ID is derived from the job's ID. If a job is
// interrupted after publishing and runs again, it therefore does not publish a second model.
inline ModelId model_id_of(const JobRecord& job) {
  return ModelId::from_bytes(job.id.bytes());
}

}  // namespace vitrine::server
