// SPDX-License-Identifier: Apache-2.0
#include "server/store/s3_client.h"

#include <fmt/core.h>

#include <algorithm>

#include "server/content/percent_encoding.h"
#include "server/store/s3_answers.h"

namespace vitrine::server {
namespace {

std::span<const std::uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

std::string of_upload(const std::string& upload) {
  return "uploadId=" + percent_encoded(upload);
}

Expected<std::string> begin(S3Client& client, const std::string& key) {
  const auto answer = client.ask({.method = "POST", .key = key, .query = "uploads="});
  if (!answer) return tl::unexpected(answer.error());
  std::string upload = s3_upload_id(answer->body);
  if (answer->status != 200 || upload.empty()) return client.refused("begin an upload", *answer);
  return upload;
}

// Uploads a part and returns its entity tag.
Expected<std::string> put_part(S3Client& client, const std::string& key, const std::string& upload,
                               std::size_t number, std::span<const std::uint8_t> bytes) {
  const auto answer =
      client.ask({.method = "PUT",
                  .key = key,
                  .query = fmt::format("partNumber={}&{}", number, of_upload(upload)),
                  .body = bytes,
                  .body_sha256 = sha256(bytes)});
  if (!answer) return tl::unexpected(answer.error());
  if (answer->status != 200) return client.refused("write a part of an object", *answer);
  return answer->field("etag");
}

// Completes a multipart upload. The response may have status 200 and contain an error, because the
// store keeps the connection alive while it works. If the response to a successful attempt is lost,
// the next attempt finds no upload. Therefore checks whether the object exists.
Expected<void> complete(S3Client& client, const std::string& key, const std::string& upload,
                        const std::string& parts) {
  const std::string text =
      fmt::format("<CompleteMultipartUpload>{}</CompleteMultipartUpload>", parts);
  const auto answer = client.ask({.method = "POST",
                                  .key = key,
                                  .query = of_upload(upload),
                                  .body = bytes_of(text),
                                  .body_sha256 = sha256(bytes_of(text))});
  if (!answer) return tl::unexpected(answer.error());
  const std::string error = s3_error(answer->body);
  if (answer->status == 200 && error.empty()) return {};
  if (error == "NoSuchUpload") {
    const auto there = client.ask({.method = "HEAD", .key = key});
    if (there && there->status == 200) return {};
  }
  return client.refused("complete an object", *answer);
}

Expected<void> put_parts(S3Client& client, const std::string& key, const std::string& upload,
                         std::span<const std::uint8_t> bytes, std::uint64_t part_bytes) {
  std::string parts;
  for (std::size_t number = 1; !bytes.empty(); ++number) {
    const auto part = bytes.first(std::min<std::size_t>(bytes.size(), part_bytes));
    const auto tag = put_part(client, key, upload, number, part);
    if (!tag) return tl::unexpected(tag.error());
    parts += fmt::format("<Part><PartNumber>{}</PartNumber><ETag>{}</ETag></Part>", number, *tag);
    bytes = bytes.subspan(part.size());
  }
  return complete(client, key, upload, parts);
}

}  // namespace

Expected<void> s3_upload(S3Client& client, const std::string& key,
                         std::span<const std::uint8_t> bytes, std::uint64_t part_bytes) {
  if (bytes.size() > part_bytes) {
    const auto upload = begin(client, key);
    if (!upload) return tl::unexpected(upload.error());
    auto done = put_parts(client, key, *upload, bytes, part_bytes);
    // Ignores an error of the abort, because the first error is the one to report. A later sweep
    // removes the remains of the upload.
    if (!done) static_cast<void>(s3_give_up(client, key, *upload));
    return done;
  }
  const auto answer =
      client.ask({.method = "PUT", .key = key, .body = bytes, .body_sha256 = sha256(bytes)});
  if (!answer) return tl::unexpected(answer.error());
  if (answer->status != 200) return client.refused("write an object", *answer);
  return {};
}

Expected<void> s3_give_up(S3Client& client, const std::string& key, const std::string& upload) {
  const auto answer = client.ask({.method = "DELETE", .key = key, .query = of_upload(upload)});
  if (!answer) return tl::unexpected(answer.error());
  if (answer->status / 100 == 2 || answer->status == 404) return {};
  return client.refused("give up an upload", *answer);
}

}  // namespace vitrine::server
