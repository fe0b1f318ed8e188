// SPDX-License-Identifier: Apache-2.0
#include "support/process/ceph_gateway.h"

#include <stdexcept>

#include "support/process/backend_process.h"
#include "support/product_names.h"
#include "support/temporary_folder.h"

namespace vitrine::test {

const std::string& ceph_gateway() {
  static const TemporaryFolder folder;
  static const BackendProcess process(
      {VITRINE_SOURCE_DIR "/tests/support/process/ceph_gateway.sh", folder.path().string()});
  static const std::string origin = "http://127.0.0.1:" + process.line();
  return origin;
}

std::string new_bucket() {
  static int made = 0;
  const std::string url = "s3://bucket" + std::to_string(++made) + "?endpoint=" + ceph_gateway();
  S3Client client(S3Address::parse(url).value(), kGatewayKeys);
  const auto answer = client.ask({.method = "PUT"});
  if (!answer || answer->status != 200) throw std::runtime_error("no bucket is made");
  return url;
}

}  // namespace vitrine::test
