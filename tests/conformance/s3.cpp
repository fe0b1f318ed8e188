// SPDX-License-Identifier: Apache-2.0
#include "conformance/object_store_suite.h"
#include "server/store/file_lock.h"
#include "server/store/s3_store.h"
#include "support/process/ceph_gateway.h"
#include "support/product_names.h"
#include "support/temporary_folder.h"

namespace vitrine::test {
namespace {

class S3 final : public ObjectStoreBackend {
 public:
  std::unique_ptr<ObjectStore> connect() override {
    return S3Store::open({.address = S3Address::parse(bucket_).value(),
                          .keys = kGatewayKeys,
                          .copies = folder_.path(),
                          .lock = [this]() -> Expected<std::shared_ptr<const ExclusiveLock>> {
                            return lock_folder(folder_.path());
                          }})
        .value();
  }

 private:
  TemporaryFolder folder_;
  const std::string bucket_ = new_bucket();
};

}  // namespace

std::unique_ptr<ObjectStoreBackend> make_object_store_backend() {
  return std::make_unique<S3>();
}

}  // namespace vitrine::test
