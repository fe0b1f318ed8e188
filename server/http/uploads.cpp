// SPDX-License-Identifier: Apache-2.0
// Resumable uploads: tus 1.0.0 (https://tus.io/protocols/resumable-upload) with its extensions
// creation, creation-with-upload, expiration and termination.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "codec/core/parse_number.h"
#include "server/http/body_sink.h"
#include "server/http/handlers.h"
#include "server/http/job_json.h"
#include "server/http/published.h"
#include "server/http/timestamp.h"
#include "server/jobs/publish_jobs.h"

namespace vitrine {
namespace {

using beast::http::field;

constexpr std::string_view kVersion = "1.0.0";
constexpr std::string_view kPieceType = "application/offset+octet-stream";

std::string_view value(const RequestHeader& header, std::string_view name) {
  const auto found = header[{name.data(), name.size()}];
  return {found.data(), found.size()};
}

std::optional<std::uint64_t> number(const RequestHeader& header, std::string_view name) {
  return parse_number<std::uint64_t>(value(header, name));
}

Response tus(Response response) {
  response.fields.emplace_back("Tus-Resumable", kVersion);
  return response;
}

// 412 where the client speaks another version, or none where it must.
std::optional<Response> refuse_version(const Request& request) {
  if (value(request.header, "Tus-Resumable") == kVersion) return std::nullopt;
  Response response = problem(412, "send Tus-Resumable: 1.0.0", request.id);
  response.fields.emplace_back("Tus-Version", kVersion);
  return tus(std::move(response));
}

unsigned status_of(UploadFault::Kind kind) {
  switch (kind) {
    case UploadFault::kTooLarge:
      return 413;
    case UploadFault::kTooMany:
      return 429;
    case UploadFault::kMoved:
      return 409;
    case UploadFault::kGone:
      return 404;
    case UploadFault::kNoRoom:
      return 507;
    case UploadFault::kIo:
      break;
  }
  return 500;
}

// What the disk said is for the operator's log.
Response refusal(const UploadFault& fault, std::string_view request_id, Services& services) {
  const unsigned status = status_of(fault.kind);
  if (status >= 500) {
    services.errors.event(Severity::kError,
                          fmt::format("request {}: {}", request_id, fault.message));
  }
  return tus(problem(status, fault.message, request_id));
}

void add_state(Response& response, const Upload& upload) {
  response.fields.emplace_back("Upload-Offset", std::to_string(upload.offset));
  response.fields.emplace_back("Upload-Expires", http_date(upload.expires / 1000));
}

// Pieces go to the disk as they come, and the answer waits until they are on it.
class UploadSink final : public BodySink {
 public:
  UploadSink(Response answer, UploadWriter writer, const UploadId& upload,
             std::string_view request_id, Services& services)
      : answer_(std::move(answer)),
        writer_(std::move(writer)),
        upload_(upload),
        request_id_(request_id),
        services_(services) {}

  std::optional<Response> take(std::span<const std::uint8_t> piece) override {
    const auto appended = writer_.append(piece);
    if (appended) return std::nullopt;
    static_cast<void>(writer_.sync());  // what has fit is there when the client asks
    return refusal(appended.error(), request_id_, services_);
  }

  Response finish() override {
    if (const auto synced = writer_.sync(); !synced)
      return refusal(synced.error(), request_id_, services_);
    const auto now = services_.uploads.find(upload_);
    if (!now) return refusal(now.error(), request_id_, services_);
    add_state(answer_, *now);
    return std::move(answer_);
  }

 private:
  Response answer_;
  UploadWriter writer_;
  const UploadId upload_;
  const std::string request_id_;
  Services& services_;
};

// The upload of the request's {id}; of another token there is none.
Uploading<Upload> own_upload(const Request& request, Services& services) {
  auto upload = services.uploads.find(request.parameters.id);
  const bool may =
      upload && (upload->token == request.caller->token || request.caller->role >= Role::kAdmin);
  if (!upload || may) return upload;
  return tl::unexpected(UploadFault{UploadFault::kGone, "there is no such upload"});
}

// A new upload, where it fits.
Uploading<Upload> announce(std::uint64_t length, std::string_view metadata, const Request& request,
                           Services& services) {
  Uploading<Upload> upload;
  const auto fits = services.quota.admit(length, [&] {
    upload = services.uploads.create(request.caller->token, length, std::string(metadata));
  });
  if (fits) return upload;
  const bool is_full = fits.error().code == ErrorCode::kLimit;
  return tl::unexpected(
      UploadFault{is_full ? UploadFault::kNoRoom : UploadFault::kIo, fits.error().message});
}

bool is_printable(std::string_view text) {
  return std::ranges::all_of(text, [](char c) { return c >= 0x20 && c < 0x7F; });
}

// `answer`, once the request's body has been appended.
Response pour(Response answer, const Upload& upload, const Request& request, Services& services) {
  const auto length = number(request.header, "Content-Length").value_or(0);
  if (length > upload.length - upload.offset) {
    return refusal({UploadFault::kTooLarge, "the body reaches beyond the Upload-Length"},
                   request.id, services);
  }
  auto writer = services.uploads.writer(upload.id, upload.offset);
  if (!writer) return refusal(writer.error(), request.id, services);
  answer.sink =
      std::make_shared<UploadSink>(answer, std::move(*writer), upload.id, request.id, services);
  return answer;
}

}  // namespace

Response show_upload_options(const Request&, Services& services) {
  Response response;
  response.status = 204;
  response.fields = {{"Allow", "GET, HEAD, POST, PATCH, DELETE, OPTIONS"},
                     {"Tus-Version", std::string(kVersion)},
                     {"Tus-Extension", "creation,creation-with-upload,expiration,termination"},
                     {"Tus-Max-Size", std::to_string(services.uploads.limits().bytes)}};
  return tus(std::move(response));
}

Response create_upload(const Request& request, Services& services) {
  if (auto refused = refuse_version(request)) return *refused;
  const auto length = number(request.header, "Upload-Length");
  const std::string_view metadata = value(request.header, "Upload-Metadata");
  if (!length) return tus(problem(400, "send Upload-Length, the number of bytes", request.id));
  if (!is_printable(metadata))
    return tus(problem(400, "Upload-Metadata is not in base64", request.id));
  const bool with_piece = value(request.header, "Content-Type") == kPieceType;
  const auto upload = announce(*length, metadata, request, services);
  if (!upload) return refusal(upload.error(), request.id, services);
  Response response;
  response.status = 201;
  response.fields = {{"Location", "/api/v1/uploads/" + upload->id.to_string()}};
  if (with_piece) return pour(tus(std::move(response)), *upload, request, services);
  add_state(response, *upload);
  return tus(std::move(response));
}

Response show_upload(const Request& request, Services& services) {
  const bool of_tus = request.header.method() == beast::http::verb::head;
  if (auto refused = refuse_version(request); refused && of_tus) return *refused;
  const auto upload = own_upload(request, services);
  if (!upload) return refusal(upload.error(), request.id, services);
  Response response = json_answer({{"id", upload->id.to_string()},
                                   {"length", upload->length},
                                   {"offset", upload->offset},
                                   {"expires", timestamp(upload->expires)}});
  add_state(response, *upload);
  response.fields.emplace_back("Upload-Length", std::to_string(upload->length));
  if (!upload->metadata.empty()) response.fields.emplace_back("Upload-Metadata", upload->metadata);
  return tus(std::move(response));
}

Response append_to_upload(const Request& request, Services& services) {
  if (auto refused = refuse_version(request)) return *refused;
  if (value(request.header, "Content-Type") != kPieceType)
    return tus(problem(415, fmt::format("send the bytes as {}", kPieceType), request.id));
  const auto offset = number(request.header, "Upload-Offset");
  if (!offset) return tus(problem(400, "send Upload-Offset, where the bytes go", request.id));
  auto upload = own_upload(request, services);
  if (!upload) return refusal(upload.error(), request.id, services);
  if (upload->offset != *offset) {
    const UploadFault moved{UploadFault::kMoved,
                            fmt::format("the offset is {}; go on from there", upload->offset)};
    return refusal(moved, request.id, services);
  }
  Response response;
  response.status = 204;
  return pour(tus(std::move(response)), *upload, request, services);
}

Response remove_upload(const Request& request, Services& services) {
  if (auto refused = refuse_version(request)) return *refused;
  const auto upload = own_upload(request, services);
  if (!upload) return refusal(upload.error(), request.id, services);
  const auto held = services.uploads.hold();
  const auto job = services.scans.jobs().job_where(
      [&](const JobRecord& one) { return PublishJobs::upload_of(one) == upload->id; });
  if (!job) return tus(internal_error(job.error(), request, services));
  if (*job) {
    return tus(problem(409,
                       fmt::format("job {} needs the upload; wait for its end or cancel it",
                                   (*job)->id.to_string()),
                       request.id));
  }
  if (const auto removed = services.uploads.remove(upload->id); !removed)
    return refusal(removed.error(), request.id, services);
  Response response;
  response.status = 204;
  return tus(std::move(response));
}

}  // namespace vitrine
