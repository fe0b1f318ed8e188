// SPDX-License-Identifier: Apache-2.0
#include "server/store/s3_answers.h"

#include <cstdio>
#include <ctime>
#include <pugixml.hpp>

namespace vitrine::server {
namespace {

// Returns the document's root element, or an empty node if it has another name or the XML is
// malformed.
pugi::xml_node root_of(pugi::xml_document& document, std::string_view xml, const char* name) {
  if (!document.load_buffer(xml.data(), xml.size())) return {};
  return document.child(name);
}

// The time of an entry without a valid time. It is in the far future, so that the entry never
// counts as old enough to be removed.
constexpr std::int64_t kNever = INT64_MAX / 2;

// Converts a time such as "2026-11-24T17:44:47.896Z" to seconds since 1970.
std::int64_t parse_time(const char* text) {
  std::tm time{};
  if (std::sscanf(text, "%4d-%2d-%2dT%2d:%2d:%2d", &time.tm_year, &time.tm_mon, &time.tm_mday,
                  &time.tm_hour, &time.tm_min, &time.tm_sec) != 6)
    return kNever;
  time.tm_year -= 1900;
  time.tm_mon -= 1;
  return ::timegm(&time);
}

}  // namespace

std::string s3_error(std::string_view xml) {
  pugi::xml_document document;
  return root_of(document, xml, "Error").child_value("Code");
}

std::string s3_upload_id(std::string_view xml) {
  pugi::xml_document document;
  return root_of(document, xml, "InitiateMultipartUploadResult").child_value("UploadId");
}

std::optional<S3Page> s3_objects(std::string_view xml) {
  pugi::xml_document document;
  const auto root = root_of(document, xml, "ListBucketResult");
  if (!root) return std::nullopt;
  S3Page page{.entries = {}, .next = root.child_value("NextContinuationToken")};
  for (const auto& object : root.children("Contents"))
    page.entries.push_back(
        {object.child_value("Key"), {}, parse_time(object.child_value("LastModified"))});
  return page;
}

std::optional<S3Page> s3_uploads(std::string_view xml) {
  pugi::xml_document document;
  const auto root = root_of(document, xml, "ListMultipartUploadsResult");
  if (!root) return std::nullopt;
  S3Page page;
  for (const auto& upload : root.children("Upload"))
    page.entries.push_back({upload.child_value("Key"), upload.child_value("UploadId"),
                            parse_time(upload.child_value("Initiated"))});
  return page;
}

}  // namespace vitrine::server
