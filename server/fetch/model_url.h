// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "codec/core/expected.h"

namespace vitrine {

// Where the stream of a model is.
struct ModelUrl {
  std::string host;           // a name or an address, without brackets
  std::string port;           // decimal
  std::string target;         // the path of the stream, without a query
  bool is_encrypted = false;  // https

  std::string authority() const;  // of the Host field
};

// Of the URL of a model's page or of its API, below any path. Fails with kBadInput.
Expected<ModelUrl> parse_model_url(std::string_view url);

}  // namespace vitrine
