// SPDX-License-Identifier: Apache-2.0
// The XML that S3 answers in.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vitrine {

// The code of an error: "NoSuchKey"; empty where the text is none.
std::string s3_error(std::string_view xml);

// Of the answer that begins an upload in parts; empty where it is none.
std::string s3_upload_id(std::string_view xml);

struct S3Entry {
  std::string key;
  std::string upload;     // of an unfinished one
  std::int64_t when = 0;  // written or begun, in seconds since 1970
};

struct S3Page {
  std::vector<S3Entry> entries;
  std::string next;  // what to go on with; empty on the last page
};

// A page of objects (ListObjectsV2); nothing where the text is none.
std::optional<S3Page> s3_objects(std::string_view xml);

// The first unfinished uploads (ListMultipartUploads).
std::optional<S3Page> s3_uploads(std::string_view xml);

}  // namespace vitrine
