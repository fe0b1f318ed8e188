// SPDX-License-Identifier: Apache-2.0
// What a back end of the jobs' catalogue supplies to be tested.
#pragma once

#include <memory>

#include "server/catalogue/catalogue.h"
#include "server/catalogue/jobs.h"

namespace vitrine::test {

class JobsBackend {
 public:
  virtual ~JobsBackend() = default;
  // A new connection to the same catalogue, empty at first.
  virtual std::unique_ptr<JobCatalogue> connect() = 0;
  virtual std::unique_ptr<Catalogue> connect_models() = 0;
};

std::unique_ptr<JobsBackend> make_jobs_backend();

}  // namespace vitrine::test
