// SPDX-License-Identifier: Apache-2.0
// A visitor of a server, through whatever stands in front of it.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "codec/core/expected.h"

namespace vitrine {

struct ProbeAnswer {
  long status = 0;
  std::map<std::string, std::string> fields;  // names in lower case
  std::string body;                           // its first kMost bytes
  std::optional<double> certificate_days;     // until the server's expires; nothing without TLS

  static constexpr std::size_t kMost = 1 << 20;
  std::string field(const std::string& name) const {
    const auto found = fields.find(name);
    return found == fields.end() ? "" : found->second;
  }
};

class Probe {
 public:
  // `origin`: "https://museum.example", no slash at its end.
  explicit Probe(std::string origin);
  ~Probe();
  Probe(const Probe&) = delete;
  Probe& operator=(const Probe&) = delete;

  // `fields`: "Name: value". kIo where there is no answer.
  Expected<ProbeAnswer> ask(const std::string& target, const std::vector<std::string>& fields = {},
                            const std::string& method = "GET");

  // The head of the answer to a GET whose connection is to become something else.
  Expected<std::string> upgrade(const std::string& target, const std::vector<std::string>& fields);

 private:
  struct Handle;
  const std::string origin_;
  std::unique_ptr<Handle> handle_;
};

}  // namespace vitrine
