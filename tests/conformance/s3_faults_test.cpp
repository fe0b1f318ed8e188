// SPDX-License-Identifier: Apache-2.0
// Tests the cases that only an S3-compatible store has: wrong keys, missing buckets, uploads in
// parts, lists of several pages, and damage during the transfer.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "server/store/s3_answers.h"
#include "server/store/s3_client.h"
#include "server/store/s3_store.h"
#include "support/held_lock.h"
#include "support/process/ceph_gateway.h"
#include "support/product_names.h"
#include "support/temporary_folder.h"

namespace vitrine::test {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr std::uint64_t kPart = 5 << 20;  // smallest size of a part that S3 accepts, in bytes

std::vector<std::uint8_t> many_bytes(std::size_t count) {
  std::vector<std::uint8_t> bytes(count);
  std::uint32_t state = 1;
  for (auto& byte : bytes)
    byte = static_cast<std::uint8_t>((state = state * 1664525 + 7) >> 24);
  return bytes;
}

std::span<const std::uint8_t> bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

class S3Faults : public testing::Test {
 protected:
  S3Options options(const std::string& url, const S3Keys& keys = kGatewayKeys) {
    return {.address = S3Address::parse(url).value(),
            .keys = keys,
            .copies = folder_.path(),
            .lock = []() -> Expected<std::shared_ptr<const ExclusiveLock>> { return nullptr; },
            .part_bytes = kPart};
  }
  std::unique_ptr<S3Store> open() { return S3Store::open(options(bucket_)).value(); }
  S3Client client() { return {S3Address::parse(bucket_).value(), kGatewayKeys}; }
  std::string fault(const std::string& url, const S3Keys& keys = kGatewayKeys) {
    const auto store = S3Store::open(options(url, keys));
    return store ? "" : store.error().message;
  }

  TemporaryFolder folder_;
  const std::string bucket_ = new_bucket();
};

TEST_F(S3Faults, AWrongSecretIsReportedAtTheStartWithoutShowingIt) {
  const std::string told = fault(bucket_, {"museum", "not-the-secret"});
  EXPECT_THAT(told, HasSubstr("403 SignatureDoesNotMatch; check store-access-key"));
  EXPECT_THAT(told, Not(HasSubstr("not-the-secret")));
  EXPECT_THAT(fault(bucket_, {"nobody", "x"}), HasSubstr("403 InvalidAccessKeyId"));
}

TEST_F(S3Faults, AMissingBucketIsReportedAtTheStart) {
  EXPECT_THAT(fault("s3://nowhere?endpoint=" + ceph_gateway()),
              HasSubstr("404 NoSuchBucket; create the bucket"));
}

TEST_F(S3Faults, TheProbeLeavesNothing) {
  open();
  const auto listed = client().ask({.query = "list-type=2"});
  ASSERT_TRUE(listed);
  EXPECT_TRUE(s3_objects(listed->body).value().entries.empty());
}

TEST_F(S3Faults, ABucketIsAlsoFoundByItsHostName) {
  const std::string port = ceph_gateway().substr(ceph_gateway().rfind(':'));
  const std::string name = bucket_.substr(0, bucket_.find('?'));
  const auto bytes = many_bytes(1'000);
  auto store =
      S3Store::open(options(name + "/museum?endpoint=http://localhost" + port + "&style=virtual"));
  ASSERT_TRUE(store) << store.error().message;
  ASSERT_TRUE((*store)->put(sha256(bytes), bytes));
  EXPECT_EQ(client()
                .ask({.method = "HEAD", .key = "museum/objects/" + to_hex(sha256(bytes))})
                .value()
                .status,
            200);
}

TEST_F(S3Faults, ALargeObjectGoesInPartsAndComesBackWhole) {
  const auto bytes = many_bytes(2 * kPart + 12'345);
  const auto store = open();
  EXPECT_TRUE(store->put(sha256(bytes), bytes).value());
  const auto head =
      client().ask({.method = "HEAD", .key = "objects/" + to_hex(sha256(bytes))}).value();
  EXPECT_THAT(head.field("etag"), HasSubstr("-3"));  // the object has three parts
  EXPECT_EQ(store->open(sha256(bytes)).value()->read(0, bytes.size()).value(), bytes);
  EXPECT_FALSE(store->put(sha256(bytes), bytes).value());
}

TEST_F(S3Faults, PuttingAnExistingObjectAgainMakesNoLocalCopy) {
  const auto bytes = many_bytes(1'000);
  const auto store = open();
  ASSERT_TRUE(store->put(sha256(bytes), bytes).value());
  std::filesystem::remove_all(folder_.path());  // prevents a local copy of the object
  EXPECT_FALSE(store->open(sha256(bytes)));
  const auto again = store->put(sha256(bytes), bytes);
  ASSERT_TRUE(again);
  EXPECT_FALSE(*again) << "it existed undamaged";
}

TEST_F(S3Faults, AnAbandonedUploadIsSweptAfterItsGracePeriod) {
  auto direct = client();
  const auto begun =
      direct.ask({.method = "POST", .key = "objects/left", .query = "uploads="}).value();
  ASSERT_FALSE(s3_upload_id(begun.body).empty());
  const auto store = open();
  const auto left = [&] {
    return s3_uploads(direct.ask({.query = "uploads="}).value().body).value().entries.size();
  };
  EXPECT_EQ(store->sweep({}, std::chrono::hours(1), kHeld).value(), 0u);
  EXPECT_EQ(left(), 1u);
  EXPECT_EQ(store->sweep({}, std::chrono::seconds(0), kHeld).value(), 0u);
  EXPECT_EQ(left(), 0u);
}

TEST_F(S3Faults, ADamagedObjectIsRefusedAndReplaced) {
  const auto bytes = many_bytes(1'000);
  const std::string key = "objects/" + to_hex(sha256(bytes));
  auto damaged = bytes;
  damaged[500] ^= 1;
  auto direct = client();
  ASSERT_TRUE(s3_upload(direct, key, damaged, kPart));
  const auto store = open();
  const auto opened = store->open(sha256(bytes));
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, ErrorCode::kState);
  EXPECT_THAT(opened.error().message, HasSubstr("is damaged in s3://"));
  std::uint64_t read = 0;
  const auto check = [&] {
    return store->check(sha256(bytes), [&](std::uint64_t count) { return read += count, true; });
  };
  EXPECT_EQ(check().value(), ObjectState::kDamaged);
  EXPECT_EQ(read, 2 * bytes.size()) << "a second download excludes damage on the way";
  EXPECT_TRUE(store->put(sha256(bytes), bytes).value());
  EXPECT_EQ(store->open(sha256(bytes)).value()->read(0, bytes.size()).value(), bytes);
  EXPECT_EQ(check().value(), ObjectState::kIntact);
  ASSERT_TRUE(store->remove(sha256(bytes)));
  EXPECT_EQ(check().value(), ObjectState::kMissing);
}

TEST_F(S3Faults, ACheckThatIsStoppedIsNotTriedAgain) {
  const auto bytes = many_bytes(1'000);
  const auto store = open();
  ASSERT_TRUE(store->put(sha256(bytes), bytes));
  int pieces = 0;
  EXPECT_FALSE(store->check(sha256(bytes), [&](std::uint64_t) { return ++pieces, false; }));
  EXPECT_EQ(pieces, 1);
  EXPECT_TRUE(store->open(sha256(bytes)));
}

TEST_F(S3Faults, TheStoreRefusesABodyThatWasChangedOnItsWay) {
  const auto answer = client().ask({.method = "PUT",
                                    .key = "objects/x",
                                    .body = bytes_of("these"),
                                    .body_sha256 = sha256(bytes_of("those"))});
  ASSERT_TRUE(answer);
  EXPECT_EQ(s3_error(answer->body), "XAmzContentSHA256Mismatch");
}

TEST_F(S3Faults, MoreObjectsThanOnePageHoldsAreAllSwept) {
  auto direct = client();
  const auto put = [&](int i) {
    std::string text = std::to_string(i);
    EXPECT_TRUE(s3_upload(direct, "objects/" + to_hex(sha256(bytes_of(text))), {}, kPart));
  };
  for (int i = 0; i < 1'003; ++i)
    put(i);
  EXPECT_EQ(open()->sweep({}, std::chrono::seconds(0), kHeld).value(), 1'003u);
}

}  // namespace
}  // namespace vitrine::test
