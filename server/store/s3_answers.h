// SPDX-License-Identifier: Apache-2.0
// Parses the XML responses of an S3 server.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vitrine::server {

// Returns the code of an error response, such as "NoSuchKey"; empty if the text is not an error.
std::string s3_error(std::string_view xml);

// Returns the upload ID in the response to CreateMultipartUpload; empty if there is none.
std::string s3_upload_id(std::string_view xml);

struct S3Entry {
  std::string key;
  std::string upload;     // ID of an unfinished upload; empty for an object
  std::int64_t when = 0;  // when the object was written or the upload begun, in seconds since 1970
};

struct S3Page {
  std::vector<S3Entry> entries;
  std::string next;  // token for the next page; empty on the last page
};

// Parses a page of objects (ListObjectsV2); nullopt if the text is not such a page.
std::optional<S3Page> s3_objects(std::string_view xml);

// Parses the first page of unfinished uploads (ListMultipartUploads); nullopt if the text is not
// such a page.
std::optional<S3Page> s3_uploads(std::string_view xml);

}  // namespace vitrine::server
