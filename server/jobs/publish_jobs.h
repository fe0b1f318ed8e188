// SPDX-License-Identifier: Apache-2.0
// Jobs that publish uploads. A job builds a model from a mesh, or verifies a .pmesh file, in the
// sandboxed child process (build_child.h), and publishes the result.
#pragma once

#include "server/jobs/job_queue.h"
#include "server/jobs/model_order.h"
#include "server/store/object_store.h"
#include "server/store/quota.h"
#include "server/store/uploads.h"

namespace vitrine::server {

// All references must outlive the jobs.
struct PublishDependencies {
  ObjectStore& store;
  Catalogue& catalogue;
  Uploads& uploads;
  Quota& quota;
  std::filesystem::path data;                                // data folder of the installation
  std::filesystem::path program = "/proc/self/exe";          // see BuildOrder::program
  std::function<std::uint64_t()> disk_reserve = no_reserve;  // returns BuildOrder::disk_reserve
};

// Returns the file name in an upload's metadata, or an empty string if there is none. Metadata are
// pairs of a key and a Base64 value, separated by commas (tus 1.0, Upload-Metadata). Clients state
// the name under the key "filename".
std::string upload_name(std::string_view metadata);

class PublishJobs {
 public:
  explicit PublishJobs(const PublishDependencies& needs) : needs_(needs) {}

  // Creates a job that carries out `order` for `owner`. The caller adds the job to the queue.
  static JobRecord job_for(const ModelOrder& order, const TokenId& owner);

  // Runs a job. If the job succeeds, removes the upload. Otherwise keeps it for another attempt.
  Expected<JobEnd> work(JobRun& run);

  // Returns the upload that a job uses, or nullopt if it uses none.
  static std::optional<UploadId> upload_of(const JobRecord& job);

 private:
  Expected<Publication> make(JobRun& run, const ModelOrder& order);
  // Returns the .pmesh file and its repairs. Also records the repairs in `run`.
  Expected<ChildResult> build(JobRun& run, const ModelOrder& order, const FileDescriptor& file);

  const PublishDependencies needs_;
};

}  // namespace vitrine::server
