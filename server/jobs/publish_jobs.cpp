// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/publish_jobs.h"

#include <sys/mman.h>
#include <sys/stat.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "codec/progressive/manifest.h"
#include "codec/progressive/signature.h"
#include "server/jobs/clock.h"
#include "server/jobs/patience.h"
#include "server/store/change.h"

namespace vitrine {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr double kChildDone = 0.98;  // progress at the end of the child's work

Expected<ModelOrder> order_of(const JobRecord& job) {
  const auto json = nlohmann::json::parse(job.parameters, nullptr, /*allow_exceptions=*/false);
  auto order = parse_model_order(json.is_object() ? json : nlohmann::json::object());
  if (order) return *order;
  return fail(ErrorCode::kState, "the job's parameters are damaged; send the request again");
}

Expected<Bytes> read_all(const FileDescriptor& file) {
  struct stat status {};
  if (::fstat(file.get(), &status) != 0)
    return fail(ErrorCode::kIo, "cannot read the upload; check the data folder");
  Bytes bytes(static_cast<std::size_t>(status.st_size));
  std::size_t read = 0;
  while (read < bytes.size()) {
    const ssize_t n =
        ::pread(file.get(), bytes.data() + read, bytes.size() - read, static_cast<off_t>(read));
    if (n <= 0) return fail(ErrorCode::kIo, "cannot read the upload; check the data folder");
    read += static_cast<std::size_t>(n);
  }
  return bytes;
}

}  // namespace

JobRecord PublishJobs::job_for(const ModelOrder& order) {
  JobRecord job;
  job.id = JobId::generate();
  job.kind = JobKind::kPublish;
  job.parameters = to_json_text(order);
  job.created = now_in_milliseconds();
  job.webhook = order.webhook;
  return job;
}

std::optional<UploadId> PublishJobs::upload_of(const JobRecord& job) {
  if (job.kind != JobKind::kPublish) return std::nullopt;
  const auto order = order_of(job);
  return order ? std::optional(order->upload) : std::nullopt;
}

// What it made is in the catalogue before the upload goes: a daemon that dies in between does
// nothing twice.
Expected<JobEnd> PublishJobs::work(JobRun& run) {
  const auto order = order_of(run.job());
  if (!order) return Unexpected(order.error());
  if (!run.job().model) {
    const auto made = make(run, *order);
    if (!made) return Unexpected(made.error());
    run.made(made->id);
    run.report("published", 1);
  }
  static_cast<void>(means_.uploads.remove(order->upload));
  return JobEnd::kDone;
}

Expected<Publication> PublishJobs::make(JobRun& run, const ModelOrder& order) {
  const auto file = means_.uploads.open(order.upload);
  if (!file && file.error().kind != UploadFault::kGone)
    return fail(ErrorCode::kIo, file.error().message);
  if (!file) {
    return fail(ErrorCode::kState, "the upload is gone or not whole; upload the file again");
  }
  auto pmesh = build(run, order, *file);
  if (!pmesh) return Unexpected(pmesh.error());
  run.report("publishing", kChildDone);
  // The model has the job's id, so that a job which is interrupted after this makes no second one.
  const PublishAs as{.state = order.publish ? ModelState::kPublished : ModelState::kDraft,
                     .id = order.replace.value_or(run.job().id),
                     .quota = &means_.quota,
                     .upload = order.upload,
                     .by = JobClaim{run.job().id, run.job().fence}};
  return patiently(run, [&] {
    return (order.replace ? replace : publish)(means_.store, means_.catalogue, *pmesh,
                                               order.metadata, as);
  });
}

Expected<Bytes> PublishJobs::build(JobRun& run, const ModelOrder& order,
                                   const FileDescriptor& file) {
  std::array<std::uint8_t, kHeaderPrefix> prefix{};
  const ssize_t n = ::pread(file.get(), prefix.data(), prefix.size(), 0);
  const bool is_built = n > 0 && is_pmesh(std::span(prefix).first(static_cast<std::size_t>(n)));
  const char* stage = is_built ? "verifying" : "building";
  run.report(stage, 0);
  BuildChild child;
  const Reaction stop(run, [&child] { child.stop(); });
  const BuildOrder how{.bits = order.bits,
                       .placement = order.placement,
                       .z_is_up = order.z_is_up,
                       .unit = order.unit,
                       .folder = means_.data,
                       .program = means_.program};
  auto pmesh = child.build(
      file, how, [&](std::string_view, double done) { run.report(stage, kChildDone * done); });
  return pmesh && is_built ? read_all(file) : std::move(pmesh);
}

}  // namespace vitrine
