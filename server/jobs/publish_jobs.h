// SPDX-License-Identifier: Apache-2.0
// Uploads become models, as jobs: a mesh is built, a .pmesh is verified, both in the sandboxed
// child, and then it is published.
#pragma once

#include "server/jobs/job_queue.h"
#include "server/jobs/model_order.h"
#include "server/store/object_store.h"
#include "server/store/quota.h"
#include "server/store/uploads.h"

namespace vitrine {

// All of it outlives the jobs.
struct PublishMeans {
  ObjectStore& store;
  Catalogue& catalogue;
  Uploads& uploads;
  Quota& quota;
  std::filesystem::path data;                        // of the installation
  std::filesystem::path program = "/proc/self/exe";  // BuildOrder::program
};

class PublishJobs {
 public:
  explicit PublishJobs(const PublishMeans& means) : means_(means) {}

  // A job for it, to be given to the queue.
  static JobRecord job_for(const ModelOrder& order);

  // Does one. The upload is gone where it succeeds, and stays for another try where not.
  Expected<JobEnd> work(JobRun& run);

  // The upload that a job is about, or was.
  static std::optional<UploadId> upload_of(const JobRecord& job);

 private:
  Expected<Publication> make(JobRun& run, const ModelOrder& order);
  Expected<std::vector<std::uint8_t>> build(JobRun& run, const ModelOrder& order,
                                            const FileDescriptor& file);

  const PublishMeans means_;
};

}  // namespace vitrine
