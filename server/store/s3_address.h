// SPDX-License-Identifier: Apache-2.0
// Where a bucket is: s3://BUCKET[/PREFIX][?endpoint=URL&region=R&style=path|virtual].
#pragma once

#include <string>
#include <string_view>

#include "codec/core/expected.h"

namespace vitrine {

struct S3Address {
  std::string bucket;
  std::string prefix;       // of every key: empty, or ends in a slash
  std::string origin;       // "https://s3.example.org:9000"
  std::string region;       // that requests are signed for
  bool is_virtual = false;  // the bucket is in the host's name, not in the path

  // Without an endpoint it is Amazon's; the style is `path` with one and `virtual` without. Fails
  // (kBadInput) with what is wrong in it.
  static Expected<S3Address> parse(std::string_view text);

  // Of the object of that key, which needs no encoding, or of the bucket where it is empty.
  // `query`: encoded, and sorted by name.
  std::string url_of(std::string_view key, std::string_view query = {}) const;
};

// All but letters, digits and "-._~" as %XX.
std::string percent_encoded(std::string_view text);

}  // namespace vitrine
