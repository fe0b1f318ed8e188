// SPDX-License-Identifier: Apache-2.0
// Serves resumable uploads: tus 1.0.0 [tus] with its extensions creation, creation-defer-length,
// creation-with-upload, checksum, expiration and termination.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "codec/core/parse_number.h"
#include "server/api/handlers.h"
#include "server/api/job_json.h"
#include "server/api/path_parameters.h"
#include "server/api/published.h"
#include "server/jobs/free_space.h"
#include "server/jobs/publish_jobs.h"
#include "server/messages/body_checksum.h"
#include "server/messages/body_sink.h"
#include "server/messages/timestamp.h"

namespace vitrine::server {
namespace {

using beast::http::field;

constexpr std::string_view kVersion = "1.0.0";
constexpr std::string_view kExtensions =
    "creation,creation-defer-length,creation-with-upload,checksum,expiration,termination";
constexpr std::string_view kPieceType = "application/offset+octet-stream";
constexpr unsigned kChecksumMismatch = 460;  // status defined by tus

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

// Returns 412 unless the request states version 1.0.0 of tus; otherwise returns nullopt.
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

// Returns the unfinished job that uses the upload, or nullopt if there is none.
Expected<std::optional<JobRecord>> job_of(const UploadId& upload, Services& services) {
  return services.scans.jobs().job_where(
      [&](const JobRecord& job) { return PublishJobs::upload_of(job) == upload; });
}

// Removes an upload and its bytes, unless a job uses it. If the catalogue cannot be read, a job may
// use the upload, so the upload stays until it expires.
void discard(const UploadId& upload, Services& services) {
  const auto held = services.uploads.hold();
  if (const auto job = job_of(upload, services); job && !*job)
    static_cast<void>(services.uploads.remove(upload));
}

// Writes the pieces of a body to an upload as they arrive. Responds when all pieces are on the
// disk. If the body does not match the client's checksum, restores the upload's previous state. If
// the disk is full, removes the upload, because its bytes would take up the space of other uploads.
// If the same request created the upload, any error removes the upload, because the client never
// learns the upload's ID.
class UploadSink final : public BodySink {
 public:
  UploadSink(Response answer, UploadWriter writer, std::optional<BodyChecksum> checksum,
             const UploadId& upload, std::string_view request_id, Services& services)
      : answer_(std::move(answer)),
        writer_(std::move(writer)),
        checksum_(std::move(checksum)),
        upload_(upload),
        request_id_(request_id),
        services_(services) {}

  std::optional<Response> take(std::span<const std::uint8_t> piece) override {
    if (checksum_) checksum_->add(piece);
    const auto appended = writer_.append(piece);
    if (appended) return std::nullopt;
    static_cast<void>(writer_.sync());  // saves the bytes so far, so that the client can resume
    return refused(appended.error());
  }

  Response finish() override {
    if (checksum_ && !checksum_->is_met()) {
      if (const auto done = writer_.take_back(); !done) return refused(done.error());
      if (is_creation()) discard(upload_, services_);
      return tus(problem(kChecksumMismatch, "the bytes do not have the checksum; send them again",
                         request_id_));
    }
    if (const auto synced = writer_.sync(); !synced) return refused(synced.error());
    const auto now = services_.uploads.find(upload_);
    if (!now) return refused(now.error());
    add_state(answer_, *now);
    return std::move(answer_);
  }

 private:
  bool is_creation() const { return answer_.status == 201; }

  Response refused(UploadFault fault) {
    const bool is_full = fault.cause == UploadFault::kNoRoom;
    if (is_full || is_creation()) discard(upload_, services_);
    if (is_full) fault.message += ", and upload the file again: its bytes were removed";
    return refusal(fault, request_id_, services_);
  }

  Response answer_;
  UploadWriter writer_;
  std::optional<BodyChecksum> checksum_;
  const UploadId upload_;
  const std::string request_id_;
  Services& services_;
};

bool is_of_caller(const Upload& upload, const Request& request) {
  return upload.token == request.caller->token || request.caller->role >= Role::kAdmin;
}

// Returns the upload of the request's {id}, or kGone if it belongs to another token and the caller
// is not an administrator.
Uploading<Upload> own_upload(const Request& request, Services& services) {
  auto upload = services.uploads.find(id_in<UploadId>(request));
  if (!upload || is_of_caller(*upload, request)) return upload;
  return tl::unexpected(UploadFault{UploadFault::kGone, "there is no such upload"});
}

// Checks that the disk's reserve stays free even after all open uploads and `length` more bytes
// have arrived. If `token` already has open uploads, they and the new upload may use at most half
// of the room that other tokens' uploads leave. Without this limit, one token could reserve the
// whole disk by opening many uploads without sending a byte.
Uploading<void> check_room(std::uint64_t length, const TokenId& token, Services& services) {
  const auto open = services.uploads.list();
  if (!open) return tl::unexpected(open.error());
  const Settings& settings = services.settings.get();
  const std::uint64_t free = free_space(settings);
  std::uint64_t room = free - std::min(free, settings.disk_reserve_bytes), own = 0;
  for (const Upload& upload : *open) {
    const std::uint64_t unsent = std::min(room, upload.length - upload.offset);
    room -= unsent;
    if (upload.token == token) own += unsent;
  }
  if (length > room) {
    return tl::unexpected(UploadFault{
        UploadFault::kNoRoom,
        fmt::format("the disk has no room for {} bytes; remove models or add disk space", length)});
  }
  const std::uint64_t share = (room + own) / 2;
  if (own == 0 || (own <= share && length <= share - own)) return {};
  return tl::unexpected(UploadFault{
      UploadFault::kTooMany,
      fmt::format("the open uploads of this token have {} bytes to come, and {} more would exceed "
                  "its share of the disk; finish or delete one",
                  own, length)});
}

// Creates an upload if it fits into the quota and leaves the disk's reserve free. An upload of
// unknown length counts with the largest allowed size.
Uploading<Upload> announce(std::optional<std::uint64_t> length, std::string_view metadata,
                           const Request& request, Services& services) {
  Uploading<Upload> upload;
  const std::uint64_t most = length.value_or(services.uploads.limits().bytes);
  const auto fits = services.quota.admit(most, [&] {
    if (const auto room = check_room(most, request.caller->token, services); !room) {
      upload = tl::unexpected(room.error());
    } else {
      upload = services.uploads.create(request.caller->token, length, std::string(metadata));
    }
  });
  if (fits) return upload;
  const bool is_full = fits.error().code == ErrorCode::kLimit;
  return tl::unexpected(
      UploadFault{is_full ? UploadFault::kNoRoom : UploadFault::kIo, fits.error().message});
}

bool is_printable(std::string_view text) {
  return std::ranges::all_of(text, [](char c) { return c >= 0x20 && c < 0x7F; });
}

// Returns a response that first appends the request's body to the upload, and then sends `answer`.
Response pour(Response answer, const Upload& upload, const Request& request, Services& services) {
  const auto length = number(request.header, "Content-Length").value_or(0);
  if (length > upload.length - upload.offset) {
    return refusal({UploadFault::kTooLarge, "the body exceeds the Upload-Length"}, request.id,
                   services);
  }
  std::optional<BodyChecksum> checksum;
  if (const auto field = value(request.header, "Upload-Checksum"); !field.empty()) {
    checksum = BodyChecksum::parse(field);
    if (!checksum) {
      return tus(problem(400,
                         fmt::format("Upload-Checksum is not one of {}, a blank and the hash in "
                                     "base64",
                                     BodyChecksum::kAlgorithms),
                         request.id));
    }
  }
  auto writer = services.uploads.writer(upload.id, upload.offset);
  if (!writer) return refusal(writer.error(), request.id, services);
  answer.sink = std::make_shared<UploadSink>(answer, std::move(*writer), std::move(checksum),
                                             upload.id, request.id, services);
  return answer;
}

}  // namespace

static Response show_upload_options(const Request&, Services& services) {
  Response response;
  response.status = 204;
  response.fields = {{"Allow", "GET, HEAD, POST, PATCH, DELETE, OPTIONS"},
                     {"Tus-Version", std::string(kVersion)},
                     {"Tus-Extension", std::string(kExtensions)},
                     {"Tus-Checksum-Algorithm", std::string(BodyChecksum::kAlgorithms)},
                     {"Tus-Max-Size", std::to_string(services.uploads.limits().bytes)}};
  return tus(std::move(response));
}

static nlohmann::ordered_json upload_json(const Upload& upload) {
  return {{"id", upload.id.to_string()},
          {"token", upload.token.to_string()},
          {"length", upload.is_length_known ? nlohmann::ordered_json(upload.length) : nullptr},
          {"offset", upload.offset},
          {"expires", timestamp(upload.expires)},
          {"metadata", upload.metadata}};
}

// Lists the caller's uploads, or all uploads if the caller is an administrator.
static Response list_uploads(const Request& request, Services& services) {
  const auto page = read_page<UploadId>(request);
  if (!page) return page.error();
  auto uploads = services.uploads.list();
  if (!uploads) return refusal(uploads.error(), request.id, services);
  std::erase_if(*uploads, [&](const Upload& upload) {
    return !is_of_caller(upload, request) || (page->after && upload.id <= *page->after);
  });
  std::ranges::sort(*uploads, {}, &Upload::id);
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  const bool has_more = uploads->size() > page->limit;
  if (has_more) uploads->resize(page->limit);
  for (const Upload& upload : *uploads)
    list.push_back(upload_json(upload));
  std::optional<std::string> next;
  if (has_more) next = uploads->back().id.to_string();
  return list_answer("uploads", std::move(list), next, request);
}

static Response create_upload(const Request& request, Services& services) {
  if (auto refused = refuse_version(request)) return *refused;
  const auto length = number(request.header, "Upload-Length");
  const std::string_view metadata = value(request.header, "Upload-Metadata");
  const bool is_deferred = value(request.header, "Upload-Defer-Length") == "1";
  if (length.has_value() == is_deferred) {
    return tus(problem(400, "send Upload-Length, the number of bytes, or Upload-Defer-Length: 1",
                       request.id));
  }
  if (!is_printable(metadata))
    return tus(problem(400, "Upload-Metadata is not in base64", request.id));
  const bool with_piece = value(request.header, "Content-Type") == kPieceType;
  const auto upload = announce(length, metadata, request, services);
  if (!upload) return refusal(upload.error(), request.id, services);
  Response response;
  response.status = 201;
  response.fields = {{"Location", "/api/v1/uploads/" + upload->id.to_string()}};
  if (with_piece) {
    Response poured = pour(tus(std::move(response)), *upload, request, services);
    if (!poured.sink) discard(upload->id, services);
    return poured;
  }
  add_state(response, *upload);
  return tus(std::move(response));
}

static Response show_upload(const Request& request, Services& services) {
  const bool of_tus = request.header.method() == beast::http::verb::head;
  if (auto refused = refuse_version(request); refused && of_tus) return *refused;
  const auto upload = own_upload(request, services);
  if (!upload) return refusal(upload.error(), request.id, services);
  Response response = json_answer(upload_json(*upload));
  add_state(response, *upload);
  if (upload->is_length_known) {
    response.fields.emplace_back("Upload-Length", std::to_string(upload->length));
  } else {
    response.fields.emplace_back("Upload-Defer-Length", "1");
  }
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
  if (const auto length = number(request.header, "Upload-Length")) {
    if (const auto stated = services.uploads.state_length(upload->id, *length); !stated) {
      if (stated.error().cause == UploadFault::kNoRoom) discard(upload->id, services);
      return refusal(stated.error(), request.id, services);
    }
    upload->length = *length;
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
  const auto job = job_of(upload->id, services);
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
  "uploadLength": {"name": "Upload-Length", "in": "header", "description": "Size of the whole file in bytes; until it is stated, the upload is not complete",
    "schema": {"type": "integer", "minimum": 0}},
  "uploadDeferLength": {"name": "Upload-Defer-Length", "in": "header", "description": "1 in place of Upload-Length, if a later request states the size",
    "schema": {"const": 1}},
  "uploadChecksum": {"name": "Upload-Checksum", "in": "header", "description": "sha1, sha256 or md5, a blank, and the hash of this request's body in Base64. If it does not fit, the response is 460 and the upload stays as it was",
    "schema": {"type": "string"}},
  "uploadMetadata": {"name": "Upload-Metadata", "in": "header", "description": "Keys, each with its Base64 value; stored and returned to the client",
    "schema": {"type": "string"}},
  "uploadOffset": {"name": "Upload-Offset", "in": "header", "required": true, "description": "Offset of this piece in bytes. It must equal the bytes received so far; otherwise the response is 409",
    "schema": {"type": "integer", "minimum": 0}}
},
"schemas": {
  "Upload": {"type": "object", "required": ["id", "token", "length", "offset", "expires", "metadata"], "properties": {
    "id": {"$ref": "#/components/schemas/Id"}, "token": {"$ref": "#/components/schemas/Id", "description": "ID of the token that created the upload"},
    "length": {"type": ["integer", "null"], "description": "Size in bytes; null until the client states it"}, "offset": {"type": "integer"}, "expires": {"$ref": "#/components/schemas/Time"},
    "metadata": {"type": "string", "description": "Upload-Metadata as the client sent it: keys, each with its Base64 value"}}},
  "UploadPage": {"type": "object", "required": ["uploads", "next"], "properties": {"next": {"$ref": "#/components/schemas/Next"},
    "uploads": {"type": "array", "items": {"$ref": "#/components/schemas/Upload"}}}}
}
})json";

static constexpr ApiRoute kUploadRoutes[] = {
    {.method = Method::kOptions,
     .path = "/api/v1/uploads",
     .handler = show_upload_options,
     .executor = Executor::kInline},
    {.method = Method::kGet,
     .path = "/api/v1/uploads",
     .handler = list_uploads,
     .executor = Executor::kDisk,
     .role = Role::kOperator,
     .doc = {.id = "listUploads",
             .summary = "Lists the caller's open uploads, oldest first; all uploads for an "
                        "administrator. DELETE ends a lost one.",
             .parameters = "limit cursor",
             .response = "UploadPage"}},
    {.method = Method::kPost,
     .path = "/api/v1/uploads",
     .handler = create_upload,
     .executor = Executor::kDisk,
     .role = Role::kOperator,
     .body = BodyKind::kPieces,
     .doc = {.id = "createUpload",
             .summary = "Creates a resumable upload (tus 1.0.0). A body of type "
                        "application/offset+octet-stream becomes its first piece.",
             .parameters =
                 "tusResumable uploadLength uploadDeferLength uploadMetadata uploadChecksum",
             .request = kPieceType,
             .is_request_optional = true,
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
     .body = BodyKind::kPieces,
     .doc = {.id = "appendToUpload",
             .summary =
                 "Appends a piece to an upload. The server responds once the piece is on disk.",
             .parameters = "tusResumable uploadOffset uploadLength uploadChecksum",
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

static constexpr ApiTag kUploadsTags[] = {
    {.name = "uploads",
     .description = "Uploads of mesh files by the tus protocol, which can be resumed."}};

const ApiNoun kUploads = {
    .routes = kUploadRoutes, .components = kUploadsComponents, .tags = kUploadsTags};

}  // namespace vitrine::server
