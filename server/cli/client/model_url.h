// SPDX-License-Identifier: Apache-2.0
// Parses the URL of a model.
#pragma once

#include <string>
#include <string_view>

#include "codec/core/expected.h"

namespace vitrine::server {

// The address of a model's stream.
struct ModelUrl {
  std::string host;           // a name or an address, without brackets
  std::string port;           // number of the port, in decimal digits
  std::string target;         // the path of the stream, without a query
  bool is_encrypted = false;  // whether the URL begins with https

  std::string authority() const;  // host and port for the Host field
  std::string resource() const;   // the path of the model's API resource
};

// Parses the URL of a model's page or of its API resource. Any path prefix is allowed. Fails with
// kBadInput for any other text.
Expected<ModelUrl> parse_model_url(std::string_view url);

}  // namespace vitrine::server
