// SPDX-License-Identifier: Apache-2.0
// The interface through which the suite tests a job catalogue implementation.
#pragma once

#include <memory>

#include "server/catalogue/catalogue.h"
#include "server/catalogue/jobs.h"
#include "support/product_names.h"

namespace vitrine::test {

class JobsBackend {
 public:
  virtual ~JobsBackend() = default;
  // Opens a new connection to the same catalogue, which is empty at first.
  virtual std::unique_ptr<JobCatalogue> connect() = 0;
  virtual std::unique_ptr<Catalogue> connect_models() = 0;
};

std::unique_ptr<JobsBackend> make_jobs_backend();

}  // namespace vitrine::test
