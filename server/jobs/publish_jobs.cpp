// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/publish_jobs.h"

#include <sys/mman.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "codec/format/manifest.h"
#include "codec/format/signature.h"
#include "server/config/base64.h"
#include "server/jobs/clock.h"
#include "server/jobs/job_claim.h"
#include "server/jobs/retry_while_unreachable.h"
#include "server/store/change.h"

namespace vitrine::server {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr double kChildDone = 0.98;  // the job's progress once the child process has ended

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

std::string upload_name(std::string_view metadata) {
  constexpr std::string_view kKey = "filename ";
  constexpr std::size_t kMost = 1'024;  // longest accepted Base64 text, in bytes
  while (!metadata.empty()) {
    std::string_view pair = metadata.substr(0, metadata.find(','));
    metadata.remove_prefix(std::min(pair.size() + 1, metadata.size()));
    pair.remove_prefix(std::min(pair.find_first_not_of(' '), pair.size()));
    if (!pair.starts_with(kKey)) continue;
    const std::string_view value = pair.substr(kKey.size());
    return value.size() > kMost ? std::string() : decode_base64(value).value_or("");
  }
  return {};
}

JobRecord PublishJobs::job_for(const ModelOrder& order, const TokenId& owner) {
  JobRecord job;
  job.id = JobId::generate();
  job.kind = JobKind::kPublish;
  job.parameters = to_json_text(order);
  job.created = now_in_milliseconds();
  job.webhook = order.webhook;
  job.owner = owner.to_string();
  return job;
}

std::optional<UploadId> PublishJobs::upload_of(const JobRecord& job) {
  if (job.kind != JobKind::kPublish) return std::nullopt;
  const auto order = order_of(job);
  return order ? std::optional(order->upload) : std::nullopt;
}

// Adds the model to the catalogue first and removes the upload afterwards. If the daemon dies in
// between, the job runs again; it does not publish a second model.
Expected<JobEnd> PublishJobs::work(JobRun& run) {
  const auto order = order_of(run.job());
  if (!order) return tl::unexpected(order.error());
  if (!run.job().model) {
    const auto made = make(run, *order);
    if (!made) return tl::unexpected(made.error());
    run.made(made->id);
    run.report("published", 1);
  }
  static_cast<void>(needs_.uploads.remove(order->upload));
  return JobEnd::kDone;
}

Expected<Publication> PublishJobs::make(JobRun& run, const ModelOrder& order) {
  const auto file = needs_.uploads.open(order.upload);
  if (!file && file.error().cause != UploadFault::kGone)
    return fail(ErrorCode::kIo, file.error().message);
  if (!file) {
    return fail(ErrorCode::kState, "the upload is gone or not whole; upload the file again");
  }
  const auto built = build(run, order, *file);
  if (!built) return tl::unexpected(built.error());
  run.report("publishing", kChildDone);
  const PublishAs as{.state = order.is_public ? ModelState::kPublished : ModelState::kDraft,
                     .id = order.replace.value_or(model_id_of(run.job())),
                     .quota = &needs_.quota,
                     .upload = order.upload,
                     .by = claim_of(run.job()),
                     .repairs = built->repairs};
  return retry_while_unreachable(run, [&] {
    return (order.replace ? replace : publish)(needs_.store, needs_.catalogue, built->file,
                                               order.metadata, as);
  });
}

Expected<ChildResult> PublishJobs::build(JobRun& run, const ModelOrder& order,
                                         const FileDescriptor& file) {
  std::array<std::uint8_t, kHeaderPrefix> prefix{};
  const ssize_t n = ::pread(file.get(), prefix.data(), prefix.size(), 0);
  const bool is_built = n > 0 && is_pmesh(std::span(prefix).first(static_cast<std::size_t>(n)));
  const char* stage = is_built ? "verifying" : "building";
  run.report(stage, 0);
  const auto upload = needs_.uploads.find(order.upload);
  BuildChild child;
  const Reaction stop(run, [&child] { child.stop(); });
  const BuildOrder how{.bits = order.bits,
                       .placement = order.placement,
                       .z_is_up = order.z_is_up,
                       .unit = order.unit,
                       .name = upload ? upload_name(upload->metadata) : std::string(),
                       .folder = needs_.data,
                       .disk_reserve = needs_.disk_reserve(),
                       .program = needs_.program};
  auto built = child.build(
      file, how, [&](std::string_view, double done) { run.report(stage, kChildDone * done); });
  if (!built) return tl::unexpected(built.error());
  if (is_built) {
    auto pmesh = read_all(file);
    if (!pmesh) return tl::unexpected(pmesh.error());
    *built = {.file = std::move(*pmesh), .repairs = order.repairs};
  }
  run.repaired(built->repairs);
  return built;
}

}  // namespace vitrine::server
