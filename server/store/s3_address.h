// SPDX-License-Identifier: Apache-2.0
// Parses the address of a bucket: s3://BUCKET[/PREFIX][?endpoint=URL&region=R&style=path|virtual].
#pragma once

#include <string>
#include <string_view>

#include "codec/core/expected.h"

namespace vitrine::server {

struct S3Address {
  std::string bucket;
  std::string prefix;       // start of every key; empty or with a final slash
  std::string origin;       // the server, such as "https://s3.example.org:9000"
  std::string region;       // region that requests are signed for
  bool is_virtual = false;  // whether the bucket is in the host name, not in the path

  // Parses an address. Without an endpoint, the server is Amazon's. The default of `style` is
  // `path` with an endpoint and `virtual` without. Fails with kBadInput and a description of the
  // fault if the address is malformed.
  static Expected<S3Address> parse(std::string_view text);

  // Returns the URL of the object with that key, or of the bucket if `key` is empty. The key must
  // contain only characters that need no percent-encoding. `query` must be encoded and sorted by
  // name.
  std::string url_of(std::string_view key, std::string_view query = {}) const;
};

}  // namespace vitrine::server
