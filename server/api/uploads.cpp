// SPDX-License-Identifier: Apache-2.0
// Serves resumable uploads: tus 1.0.0 (https://tus.io/protocols/resumable-upload) with its
// extensions creation, creation-with-upload, expiration and termination.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "codec/core/parse_number.h"
#include "server/api/handlers.h"
#include "server/api/job_json.h"
#include "server/api/path_parameters.h"
#include "server/api/published.h"
#include "server/jobs/publish_jobs.h"
#include "server/messages/body_sink.h"
#include "server/messages/timestamp.h"

namespace vitrine::server {
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

// Returns 412 unless the request states this version of tus. Otherwise returns nullopt.
std::optional<Response> refuse_version(const Request& request) {
  if (value(request.header, "Tus-Resumable") == kVersion) return std::nullopt;
  Response response = problem(412, "send Tus-Resumable: 1.0.0", request.id);
  response.fields.emplace_back("Tus-Version", kVersion);
  return tus(std::move(response));
}

unsigned status_of(UploadFault::Cause kind) {
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

// Returns the response to a failed upload. Errors of the server are also logged.
Response refusal(const UploadFault& fault, std::string_view request_id, Services& services) {
  const unsigned status = status_of(fault.cause);
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

// Writes the pieces of a body to an upload as they arrive. The response is sent once they are on
// the disk.
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
    static_cast<void>(writer_.sync());  // saves the bytes that fit, so that the client can resume
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

// Returns the upload of the request's {id}, or kGone if it belongs to another token and the caller
// is not an administrator.
Uploading<Upload> own_upload(const Request& request, Services& services) {
  auto upload = services.uploads.find(id_in<UploadId>(request));
  const bool may =
      upload && (upload->token == request.caller->token || request.caller->role >= Role::kAdmin);
  if (!upload || may) return upload;
  return tl::unexpected(UploadFault{UploadFault::kGone, "there is no such upload"});
}

// Creates an upload if it fits into the quota.
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

// Returns a response that first appends the request's body to the upload and then becomes `answer`.
Response pour(Response answer, const Upload& upload, const Request& request, Services& services) {
  const auto length = number(request.header, "Content-Length").value_or(0);
  if (length > upload.length - upload.offset) {
    return refusal({UploadFault::kTooLarge, "the body exceeds the Upload-Length"}, request.id,
                   services);
  }
  auto writer = services.uploads.writer(upload.id, upload.offset);
  if (!writer) return refusal(writer.error(), request.id, services);
  answer.sink =
      std::make_shared<UploadSink>(answer, std::move(*writer), upload.id, request.id, services);
  return answer;
}

}  // namespace

static Response show_upload_options(const Request&, Services& services) {
  Response response;
  response.status = 204;
  response.fields = {{"Allow", "GET, HEAD, POST, PATCH, DELETE, OPTIONS"},
                     {"Tus-Version", std::string(kVersion)},
                     {"Tus-Extension", "creation,creation-with-upload,expiration,termination"},
                     {"Tus-Max-Size", std::to_string(services.uploads.limits().bytes)}};
  return tus(std::move(response));
}

static Response create_upload(const Request& request, Services& services) {
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

static Response show_upload(const Request& request, Services& services) {
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

static Response append_to_upload(const Request& request, Services& services) {
  if (auto refused = refuse_version(request)) return *refused;
  if (value(request.header, "Content-Type") != kPieceType)
    return tus(problem(415, fmt::format("send the bytes as {}", kPieceType), request.id));
  const auto offset = number(request.header, "Upload-Offset");
  if (!offset)
    return tus(problem(400, "send Upload-Offset, the position of the first byte", request.id));
  auto upload = own_upload(request, services);
  if (!upload) return refusal(upload.error(), request.id, services);
  if (upload->offset != *offset) {
    const UploadFault moved{UploadFault::kMoved,
                            fmt::format("the offset is {}; continue from there", upload->offset)};
    return refusal(moved, request.id, services);
  }
  Response response;
  response.status = 204;
  return pour(tus(std::move(response)), *upload, request, services);
}

static Response remove_upload(const Request& request, Services& services) {
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

static constexpr std::string_view kUploadsComponents = R"json({
"parameters": {
  "tusResumable": {"name": "Tus-Resumable", "in": "header", "required": true, "schema": {"const": "1.0.0"}},
  "uploadLength": {"name": "Upload-Length", "in": "header", "required": true, "description": "Size of the whole file in bytes",
    "schema": {"type": "integer", "minimum": 0}},
  "uploadMetadata": {"name": "Upload-Metadata", "in": "header", "description": "Keys, each with its Base64 value; stored and returned to the client",
    "schema": {"type": "string"}},
  "uploadOffset": {"name": "Upload-Offset", "in": "header", "required": true, "description": "Offset of this piece in bytes. It must equal the bytes received so far; otherwise the response is 409",
    "schema": {"type": "integer", "minimum": 0}}
},
"schemas": {
  "Upload": {"type": "object", "required": ["id", "length", "offset", "expires"], "properties": {
    "id": {"$ref": "#/components/schemas/Id"}, "length": {"type": "integer"}, "offset": {"type": "integer"},
    "expires": {"$ref": "#/components/schemas/Time"}}}
}
})json";

static constexpr ApiRoute kUploadRoutes[] = {
    {.method = Method::kOptions,
     .path = "/api/v1/uploads",
     .handler = show_upload_options,
     .executor = Executor::kInline},
    {.method = Method::kPost,
     .path = "/api/v1/uploads",
     .handler = create_upload,
     .executor = Executor::kDisk,
     .role = Role::kOperator,
     .reads_body = false,
     .doc = {.id = "createUpload",
             .summary = "Creates a resumable upload (tus 1.0.0). A body of type "
                        "application/offset+octet-stream becomes its first piece.",
             .parameters = "tusResumable uploadLength uploadMetadata",
             .status = 201}},
    {.method = Method::kOptions,
     .path = "/api/v1/uploads/{id}",
     .handler = show_upload_options,
     .executor = Executor::kInline},
    {.method = Method::kGet,
     .path = "/api/v1/uploads/{id}",
     .handler = show_upload,
     .executor = Executor::kDisk,
     .role = Role::kOperator,
     .doc = {.id = "getUpload",
             .summary = "Returns how many bytes of an upload the server has received. HEAD "
                        "returns them in Upload-Offset.",
             .response = "Upload"}},
    {.method = Method::kPatch,
     .path = "/api/v1/uploads/{id}",
     .handler = append_to_upload,
     .executor = Executor::kDisk,
     .role = Role::kOperator,
     .reads_body = false,
     .doc = {.id = "appendToUpload",
             .summary =
                 "Appends a piece to an upload. The server responds once the piece is on disk.",
             .parameters = "tusResumable uploadOffset",
             .request = "application/offset+octet-stream",
             .status = 204}},
    {.method = Method::kDelete,
     .path = "/api/v1/uploads/{id}",
     .handler = remove_upload,
     .executor = Executor::kDisk,
     .role = Role::kOperator,
     .doc = {.id = "removeUpload",
             .summary = "Discards an upload.",
             .parameters = "tusResumable",
             .status = 204}},
};

const ApiNoun kUploads = {.routes = kUploadRoutes, .components = kUploadsComponents};

}  // namespace vitrine::server
